// SPDX-License-Identifier: BSD-3-Clause
// Contacts of a hull with the seabed, present or imminent.
//
// Model: the hull is the union of 41 spheres along its axis (4 cm apart for a hull of 1.6 m), each with the
// spheroid's radius there. Each sphere is tested against the tangent planes of the seabed below its centre
// and on both sides of it. A plane whose nearest point lies in the water (the far side of a ridge) is
// ignored. Accuracy: between spheres the hull extends by less than 5 mm over an edge of any slope. Missed are
// pinnacles thinner than half the hull's length, and walls steeper than 80 degrees, until bow, centre or
// stern come near them. Pure functions, safe in any number of threads.
#pragma once

#include <vector>

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim {

// Point of the hull's surface and the plane that it meets.
struct HullContact {
  Vec3 point_ned_m = Vec3::Zero();   // point on the hull
  Vec3 normal_ned = -Vec3::UnitZ();  // unit, out of the seabed
  double gap_m = 0;                  // distance from the plane; negative when below it
};

// Finds the contacts of a hull in the given pose with a gap below `margin_m` (0 or above): for each of the
// planes below and on the sides at most three (bow, middle and stern third, the least gap of each); none when
// it is far from the seabed. `contacts` is cleared and filled, so that its storage is kept between calls.
void find_contacts(const HullShape& hull, const Vec3& position_ned_m, const Quaternion& orientation,
                   const Seabed& seabed, double margin_m, std::vector<HullContact>& contacts);

}  // namespace halocline::vehicle_sim
