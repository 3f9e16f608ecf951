// SPDX-License-Identifier: BSD-3-Clause
// Contacts of two hulls, present or imminent.
//
// Model: a spheroid with half axes a >= b is the union of spheres with centres between its foci and radii r:
//
//   centre = s c,  c^2 = a^2 - b^2,  r = b sqrt(1 - s^2),  -1 <= s <= 1
//
// The distance of two spheroids is thus the minimum over s_1 and s_2 of
//
//   |p_1 - p_2| - r_1 - r_2
//
// which is a convex function. A pattern search with halved steps finds it, to 0.1 mm for hulls that do not
// overlap. Pure functions, safe in any number of threads.
#pragma once

#include <vector>

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

struct HullPose {
  HullShape hull;
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 axis_ned = Vec3::UnitX();  // forward, unit
};

struct VehicleContact {
  Vec3 point_ned_m = Vec3::Zero();  // midway between the hulls
  Vec3 normal_ned = Vec3::UnitX();  // unit, from the second hull to the first
  double gap_m = 0;                 // negative when they overlap
};

// Finds the contacts with a gap below `margin_m` (0 or above): at most three along the first hull (bow,
// middle and stern third, the least gap of each); none when the hulls are far apart. `contacts` is cleared
// and filled.
void find_vehicle_contacts(const HullPose& first, const HullPose& second, double margin_m,
                           std::vector<VehicleContact>& contacts);

// Path of a hull during a step, along a straight line and by the shortest rotation.
struct HullPath {
  HullShape hull;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Quaternion orientation_from = Quaternion::Identity(), orientation_to = Quaternion::Identity();

  HullPose at(double time) const;  // `time`: 0 to 1
};
HullPath path_of(const HullShape& hull, const VehicleState& from, const VehicleState& to);

// Finds the contacts at the end of the step. When the hulls overlap there, it finds those at the last instant
// before the overlap (bisection to 1/128 of the step), since after it pointed ends may have passed each
// other, and the direction that separates them would lead further through. Returns the instant, 0 to 1.
double find_first_touch(const HullPath& first, const HullPath& second, double margin_m,
                        std::vector<VehicleContact>& contacts);

}  // namespace halocline::vehicle_sim
