// SPDX-License-Identifier: BSD-3-Clause
// Reading of a whole log into a timeline of the run.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/logs/log_reader.h"
#include "runs/timeline/run_time_base.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

// Returns how a log's times become simulation time, from all its states and CLOCKs.
RunTimeBase time_of(LogReader& log);

// Timeline of a log, with remarks on the log.
struct LoggedTimeline {
  RunTimeline timeline;
  std::vector<std::string> remarks;  // sentences: damage, data left out, times shifted
  bool is_whole = true;              // false when the log is damaged, as by report_damage
};

// Reads the logs (the parts of one log, in order) twice: first for the times, then for all messages. The
// scenario's text is taken from the configuration beside the first log when they do not hold it. Throws as
// LogReader.
LoggedTimeline read_timeline(const std::vector<std::string>& logs, TimelineLimits limits = {});

// Returns the configuration that the run of these logs recorded, either in the logs or beside the first.
// Throws InvalidArgument when there is none, and bus::ConfigErrors when it cannot be read.
bus::ConfigFile recorded_configuration(const std::vector<std::string>& logs,
                                       const std::vector<std::string>& overrides = {});

void print_remarks(std::ostream& out, const LoggedTimeline& log);

void print_summary(std::ostream& out, const RunTimeline& timeline);

}  // namespace halocline::clients
