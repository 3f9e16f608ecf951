// SPDX-License-Identifier: BSD-3-Clause
// Seabed for the contact with hulls: near each point it is a plane.
//
// World frame, NED, metres. This is the narrow view of a terrain that contact needs, so that any terrain (or
// a formula, in tests) can implement it. Implementations are immutable: calls from several threads may
// overlap.
#pragma once

#include <optional>

#include "core/frames.h"

namespace halocline::vehicle_sim {

struct SeabedPlane {
  double z_m = 0;                    // z of the seabed at that point
  Vec3 normal_ned = -Vec3::UnitZ();  // unit, out of the seabed: its z component is negative
};

class Seabed {
 public:
  virtual ~Seabed() = default;
  // Empty where the seabed is unknown (outside of the map, no data): there is no contact there.
  virtual std::optional<SeabedPlane> plane_at(double north_m, double east_m) const = 0;
};

}  // namespace halocline::vehicle_sim
