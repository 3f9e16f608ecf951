// SPDX-License-Identifier: BSD-3-Clause
// The ground as a vehicle feels it: near a point of the plane, a plane.
//
// World frame, NED, metres. The narrow view of a terrain that contact needs, so that any terrain (or a
// formula, in tests) can stand behind it. Implementations are immutable: calls from several threads may
// overlap.
#pragma once

#include <optional>

#include "core/frames.h"

namespace halocline::vehicle_sim {

// The plane tangent to the ground at the given point.
struct SeabedPlane {
  double z_m = 0;                    // of the ground at that point
  Vec3 normal_ned = -Vec3::UnitZ();  // unit, out of the ground: its z is below 0
};

class Seabed {
 public:
  virtual ~Seabed() = default;
  // Empty where the ground is not known (outside of the map, no data): there is no contact there.
  virtual std::optional<SeabedPlane> plane_at(double north_m, double east_m) const = 0;
};

}  // namespace halocline::vehicle_sim
