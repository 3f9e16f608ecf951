// A whole log as a mission.
#pragma once

#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "clients/mission/mission_store.h"
#include "clients/mission/mission_time.h"

namespace halocline::clients {

// How a log's times become simulation time, by all its states and CLOCKs.
MissionTime time_of(LogReader& log);

// Reads the logs (the parts of one, in order) twice: for the times, then for all. Throws as LogReader.
MissionStore read_mission(const std::vector<std::string>& logs, MissionLimits limits = {});

}  // namespace halocline::clients
