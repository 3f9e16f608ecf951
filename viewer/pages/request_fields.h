// SPDX-License-Identifier: BSD-3-Clause
// Readers of the members of a request, with checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/timeline/mission_store.h"
#include "runs/timeline/mission_vehicle.h"

namespace halocline::monitor {

// Each throws InvalidArgument, which names the member and the allowed values, when the member is missing or
// invalid.
double number_in(const nlohmann::json& request, const char* member, double lowest, double highest);
std::int64_t integer_in(const nlohmann::json& request, const char* member, std::int64_t lowest,
                        std::int64_t highest);
std::string text_in(const nlohmann::json& request, const char* member);

struct Window {
  SimTime from, to;
};
// Reads the members from_s and to_s.
Window window_in(const nlohmann::json& request);
// Reads the member max_points; 1000 when it is missing.
std::size_t max_points_in(const nlohmann::json& request);
// Reads a vehicle, given by its index.
const clients::MissionVehicle& vehicle_in(const clients::MissionStore& mission, const nlohmann::json& request,
                                          const char* member);

}  // namespace halocline::monitor
