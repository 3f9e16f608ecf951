// SPDX-License-Identifier: BSD-3-Clause
// Texts shared by the charts of a report.
#pragma once

#include <string>

#include "core/frames.h"
#include "core/sim_time.h"
#include "runs/timeline/packet_reasons.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

std::string time_text(double seconds);      // "45.2 s", "1 h 02 min 03 s"
std::string distance_text(double metres);   // "200 m", "1.5 km"
std::string place_text(const Vec3& ned_m);  // "120 m north, -40 m east, 30 m deep"
std::string packet_title(const packet_outcome_t& outcome,
                         const VehicleName& name);  // "auv-1:12 to auv-2 at 45.2 s"

std::string step_text(double seconds);  // "30 s", "10 min", "2 h"
// Returns the smallest of 1, 2, 5, 10, 20, 30 s, and so on in minutes and hours, that is not below `least_s`.
double round_time_step(double least_s);

// Time axis of a chart from `begin` to `end`, in seconds, with tics at round instants in a fitting unit.
struct TimeAxis {
  double begin_s = 0, end_s = 1, step_s = 1;
  double unit_s = 1;  // length of the unit: a second, a minute or an hour
  const char* unit = "s";
};
TimeAxis time_axis(SimTime begin, SimTime end, int max_tics);

}  // namespace halocline::clients
