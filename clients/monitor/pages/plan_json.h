// SPDX-License-Identifier: BSD-3-Clause
// What a vehicle's autopilot is to do, and does: README.md has the members. Pure.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "clients/mission/mission_vehicle.h"
#include "clients/monitor/pages/request_fields.h"
#include "core/sim_time.h"

namespace halocline::monitor {

// The plan that held at an instant; null when none is known.
nlohmann::json plan_json(const clients::MissionVehicle& vehicle, SimTime at);

// "Follows leg 2 of 4, avoiding the seabed"; empty when it is not known.
std::string activity_at(const clients::MissionVehicle& vehicle, SimTime at);
// Each with the instant from which on it did so.
nlohmann::json activities_json(const clients::MissionVehicle& vehicle, const Window& window);

}  // namespace halocline::monitor
