// SPDX-License-Identifier: BSD-3-Clause
// Where two hulls touch, or are about to.
//
// Model: a spheroid with half axes a >= b is the union of all spheres whose centres lie between its foci, at
// s c with c^2 = a^2 - b^2 and -1 <= s <= 1, and whose radii are b sqrt(1 - s^2). So the distance between two
// of them is the least of |p_1 - p_2| - r_1 - r_2 over two places s_1, s_2: a convex function, whose least
// value a search that halves its step finds; accuracy 0.1 mm for hulls that do not lie in each other. Pure
// functions; any number of threads.
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
  double gap_m = 0;                 // negative when they lie in each other
};

// Contacts with a gap below `margin_m` (0 or above): at most three along the first hull (bow, middle and
// stern third, the least gap of each), none far from each other. `contacts` is cleared and filled.
void find_vehicle_contacts(const HullPose& first, const HullPose& second, double margin_m,
                           std::vector<VehicleContact>& contacts);

// A hull on its way through a step, along a straight line and the shortest turn.
struct HullPath {
  HullShape hull;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Quaternion orientation_from = Quaternion::Identity(), orientation_to = Quaternion::Identity();

  HullPose at(double time) const;  // 0 to 1
};
HullPath path_of(const HullShape& hull, const VehicleState& from, const VehicleState& to);

// Contacts at the end of the step or, when the hulls would lie in each other then, at the last instant before
// (bisection to 1/128 of the step): beyond it pointed ends have passed each other, and the way apart leads
// on. Returns the instant, 0 to 1.
double find_first_touch(const HullPath& first, const HullPath& second, double margin_m,
                        std::vector<VehicleContact>& contacts);

}  // namespace halocline::vehicle_sim
