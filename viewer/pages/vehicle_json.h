// SPDX-License-Identifier: BSD-3-Clause
// Time series of one vehicle over a window of time, in JSON; viewer/README.md has their members.
#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "runs/timeline/run_timeline.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/pages/request_fields.h"

namespace halocline::monitor {

nlohmann::json vehicle_series_json(const clients::RunTimeline& timeline,
                                   const clients::VehicleRecord& vehicle, const TimeWindow& window,
                                   std::size_t max_points);

nlohmann::json tracks_json(const clients::RunTimeline& timeline, const TimeWindow& window,
                           std::size_t max_points);

}  // namespace halocline::monitor
