// SPDX-License-Identifier: BSD-3-Clause
// The series of one vehicle over a window of time: README.md has their members. Pure.
#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "clients/mission/mission_store.h"
#include "clients/mission/mission_vehicle.h"
#include "clients/monitor/pages/request_fields.h"

namespace halocline::monitor {

nlohmann::json vehicle_series_json(const clients::MissionStore& mission,
                                   const clients::MissionVehicle& vehicle, const Window& window,
                                   std::size_t max_points);

// Where all vehicles were.
nlohmann::json tracks_json(const clients::MissionStore& mission, const Window& window,
                           std::size_t max_points);

}  // namespace halocline::monitor
