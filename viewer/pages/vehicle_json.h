// SPDX-License-Identifier: BSD-3-Clause
// Time series of one vehicle over a window of time, in JSON; README.md has their members.
#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "runs/timeline/mission_store.h"
#include "runs/timeline/mission_vehicle.h"
#include "viewer/pages/request_fields.h"

namespace halocline::monitor {

nlohmann::json vehicle_series_json(const clients::MissionStore& mission,
                                   const clients::MissionVehicle& vehicle, const Window& window,
                                   std::size_t max_points);

// Returns the tracks of all vehicles.
nlohmann::json tracks_json(const clients::MissionStore& mission, const Window& window,
                           std::size_t max_points);

}  // namespace halocline::monitor
