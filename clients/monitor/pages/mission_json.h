// SPDX-License-Identifier: BSD-3-Clause
// What a page is shown of the mission as a whole, as JSON: README.md has its members. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/mission/mission_store.h"
#include "clients/mission/mission_vehicle.h"
#include "clients/monitor/pages/frames.h"
#include "clients/monitor/pages/playback.h"
#include "clients/monitor/sources/source.h"
#include "core/sim_time.h"

namespace halocline::monitor {

nlohmann::json hello_json(const Source& source, bool may_command);

// The scenario, vehicles and water as of an instant.
nlohmann::json mission_json(const Source& source, SimTime at);

// The overview of the terrain; empty where none is known.
std::optional<DepthGrid> overview_grid(const clients::MissionStore& mission);

nlohmann::json state_json(const Source& source, const Playback& playback);
// Whether what differs is more than numbers that change all the time.
bool is_same_condition(const nlohmann::json& state, const nlohmann::json& other);

// "rudder stuck at 5 degrees".
std::string fault_text(const vehicle_fault_t& fault);
// Those that hold at an instant.
std::vector<vehicle_fault_t> faults_at(const clients::MissionVehicle& vehicle, SimTime at);

}  // namespace halocline::monitor
