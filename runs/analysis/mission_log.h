// SPDX-License-Identifier: BSD-3-Clause
// Reading of a whole log into a timeline of the run.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/logs/log_reader.h"
#include "runs/timeline/mission_store.h"
#include "runs/timeline/mission_time.h"

namespace halocline::clients {

// Returns how a log's times become simulation time, from all its states and CLOCKs.
MissionTime time_of(LogReader& log);

// Timeline of a log, with remarks on the log.
struct MissionLog {
  MissionStore mission;
  std::vector<std::string> remarks;  // sentences: damage, data left out, times shifted
  bool is_whole = true;              // false when the log is damaged, as by report_damage
};

// Reads the logs (the parts of one log, in order) twice: first for the times, then for all messages. The
// scenario's text is taken from the configuration beside the first log when they do not hold it. Throws as
// LogReader.
MissionLog read_mission(const std::vector<std::string>& logs, MissionLimits limits = {});

// Returns the configuration that the run of these logs recorded, either in the logs or beside the first.
// Throws InvalidArgument when there is none, and bus::ConfigErrors when it cannot be read.
bus::ConfigFile recorded_configuration(const std::vector<std::string>& logs,
                                       const std::vector<std::string>& overrides = {});

// Prints a line for each remark.
void print_remarks(std::ostream& out, const MissionLog& log);

// Prints the rows of mission_summary().
void print_summary(std::ostream& out, const MissionStore& mission);

}  // namespace halocline::clients
