// SPDX-License-Identifier: BSD-3-Clause
// Messages to a page about the run as a whole, in JSON; viewer/README.md has their members.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/timeline/run_timeline.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/pages/binary_messages.h"
#include "viewer/pages/playback.h"
#include "viewer/sources/source.h"

namespace halocline::monitor {

nlohmann::json hello_json(const Source& source, bool may_command);

// Returns the scenario, its vehicles and the water at one time.
nlohmann::json run_json(const Source& source, SimTime at);

// Returns the overview of the terrain; nothing when none is known.
std::optional<DepthGrid> overview_grid(const clients::RunTimeline& timeline);

nlohmann::json state_json(const Source& source, const Playback& playback);
// Returns true when two states differ at most in numbers that change all the time.
bool is_same_condition(const nlohmann::json& state, const nlohmann::json& other);

// Returns a fault as text: "rudder stuck at 5 degrees".
std::string fault_text(const vehicle_fault_t& fault);
std::vector<vehicle_fault_t> faults_at(const clients::VehicleRecord& vehicle, SimTime at);

}  // namespace halocline::monitor
