// SPDX-License-Identifier: BSD-3-Clause
// Descriptions in words of an autopilot's activity and of the progress of its plan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/messages/messages.h"
#include "core/frames.h"

namespace halocline::clients {

// Returns the waypoints of one behaviour of a plan, in order, NED, m.
std::vector<Vec3> waypoints_of(const vehicle_plan_t& plan, std::int32_t behaviour_index);

// Returns the autopilot's activity: "follows leg 2 of 4, kept above the seabed". `plan` may be null.
std::string activity_text(const autopilot_status_t& status, const vehicle_plan_t* plan);

// Returns the progress of the plan: "steers for waypoint 3 of 4", "has done its plan and holds".
std::string progress_text(const vehicle_plan_t& plan);

// Rounds a value for a text without decimals. A negative value that rounds to 0 yields 0 without a sign, so
// that no "-0 m" is printed.
double whole_number(double value);

}  // namespace halocline::clients
