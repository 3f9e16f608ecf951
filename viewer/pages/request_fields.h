// SPDX-License-Identifier: BSD-3-Clause
// Readers of the members of a request, with checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/timeline/run_timeline.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::monitor {

// Each throws InvalidArgument, which names the member and the allowed values, when the member is missing or
// invalid.
double number_in(const nlohmann::json& request, const char* member, double lowest, double highest);
std::int64_t integer_in(const nlohmann::json& request, const char* member, std::int64_t lowest,
                        std::int64_t highest);
std::string text_in(const nlohmann::json& request, const char* member);

struct TimeWindow {
  SimTime from, to;
};
// Reads the members from_s and to_s.
TimeWindow window_in(const nlohmann::json& request);
// Reads the member max_points; 1000 when it is missing.
std::size_t max_points_in(const nlohmann::json& request);
// Reads a vehicle, given by its index.
const clients::VehicleRecord& vehicle_in(const clients::RunTimeline& timeline, const nlohmann::json& request,
                                         const char* member);

}  // namespace halocline::monitor
