// SPDX-License-Identifier: BSD-3-Clause
// A whole log as a mission.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/logs/log_reader.h"
#include "clients/mission/mission_store.h"
#include "clients/mission/mission_time.h"

namespace halocline::clients {

// How a log's times become simulation time, by all its states and CLOCKs.
MissionTime time_of(LogReader& log);

struct MissionLog {
  MissionStore mission;
  std::vector<std::string> remarks;  // sentences: damage, what was left out, times that were moved
  bool is_whole = true;              // as report_damage has it
};

// Reads the logs (the parts of one, in order) twice: for the times, then for all. Where they do not hold the
// scenario its text is taken from the configuration beside the first. Throws as LogReader.
MissionLog read_mission(const std::vector<std::string>& logs, MissionLimits limits = {});

// The configuration that the run of these logs recorded: in them, or else beside the first. Throws
// InvalidArgument where there is none, and bus::ConfigErrors where it cannot be read.
bus::ConfigFile recorded_configuration(const std::vector<std::string>& logs,
                                       const std::vector<std::string>& overrides = {});

// A line for each remark.
void print_remarks(std::ostream& out, const MissionLog& log);

// The rows of mission_summary, for a person.
void print_summary(std::ostream& out, const MissionStore& mission);

}  // namespace halocline::clients
