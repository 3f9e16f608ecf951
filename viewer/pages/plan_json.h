// SPDX-License-Identifier: BSD-3-Clause
// Plan and activity of a vehicle's autopilot in JSON; viewer/README.md has the members.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/pages/request_fields.h"

namespace halocline::monitor {

// Returns the plan that was valid at one time, else the first one known; null when none is known.
nlohmann::json plan_json(const clients::VehicleRecord& vehicle, SimTime at);

// Returns a sentence such as "Follows leg 2 of 4, avoiding the seabed"; empty when the activity is unknown.
std::string activity_at(const clients::VehicleRecord& vehicle, SimTime at);
// Returns the activities within the window, each with the time of its beginning.
nlohmann::json activities_json(const clients::VehicleRecord& vehicle, const TimeWindow& window);

}  // namespace halocline::monitor
