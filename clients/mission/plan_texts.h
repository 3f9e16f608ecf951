// SPDX-License-Identifier: BSD-3-Clause
// What an autopilot does and how far its plan has come, in words; whole numbers in texts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/messages.h"
#include "core/frames.h"

namespace halocline::clients {

// Waypoints of one behaviour of a plan, in order.
std::vector<Vec3> waypoints_of(const vehicle_plan_t& plan, std::int32_t behaviour_index);

// "follows leg 2 of 4, kept above the seabed"; `plan` may be null.
std::string activity_text(const autopilot_status_t& status, const vehicle_plan_t* plan);

// How far the plan has come: "steers for waypoint 3 of 4", "has done its plan and holds".
std::string progress_text(const vehicle_plan_t& plan);

// Rounded for a text without decimals: what rounds to 0 from below is 0 without a sign, so no "-0 m".
double whole_number(double value);

}  // namespace halocline::clients
