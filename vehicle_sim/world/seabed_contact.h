// SPDX-License-Identifier: BSD-3-Clause
// Where a hull touches the ground, or is about to.
//
// Model: the hull is the union of spheres along its axis (41 a hull, 4 cm apart for one of 1.6 m), each as
// wide as the spheroid there. A sphere is held against the tangent planes of the ground below its centre and
// to both sides of it; a plane whose nearest point hangs in the water (the far side of a ridge) does not
// count. Accuracy: the hull bulges out by less than 5 mm between spheres over an edge of any slope. Missed:
// pinnacles thinner than half the hull's length, until bow, centre or stern come near them, and walls steeper
// than 80 degrees likewise. Pure functions; any number of threads.
#pragma once

#include <vector>

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim {

// One point of the hull's surface and the plane it meets.
struct HullContact {
  Vec3 point_ned_m = Vec3::Zero();   // on the hull
  Vec3 normal_ned = -Vec3::UnitZ();  // unit, out of the ground
  double gap_m = 0;                  // distance from the plane; negative when in the ground
};

// Contacts with a gap below `margin_m` (0 or above) of a hull in the given pose: at most three along the hull
// (bow, middle, stern third, the least gap of each) for each of the planes below and beside it; none far from
// the ground. `contacts` is cleared and filled: its storage is kept between calls.
void find_contacts(const HullShape& hull, const Vec3& position_ned_m, const Quaternion& orientation,
                   const Seabed& seabed, double margin_m, std::vector<HullContact>& contacts);

}  // namespace halocline::vehicle_sim
