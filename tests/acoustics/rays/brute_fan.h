// SPDX-License-Identifier: BSD-3-Clause
// All rays of one link by a dense fan of plainly followed rays (tests/acoustics/rays/brute_ray.h): an
// independent reference for tests, thousands of times slower than the solvers.
//
// Neighbours of the fan with one history of bounces whose depths at the receiver's range lie on both sides of
// the receiver bracket a ray, which bisection finds. Between neighbours of different histories the fan is
// halved down to rounding; between neighbours that turned in different layers, to a microradian. Where
// the slopes of depth against launch angle at two neighbours show that depth turns towards the receiver
// between them, the turn is sought and split at. The fan is denser about the angles that graze a knot.
#pragma once

#include <optional>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "tests/acoustics/rays/brute_ray.h"

namespace halocline::acoustics {

struct BruteEigenray {
  double delay_s, amplitude, phase_rad, launch_rad, arrival_rad;
  int surface, bottom, caustics;
};

// Rays launched within `steepest_rad`, from a fan of `count` even steps; the angle 0 alone is left out.
std::vector<BruteEigenray> brute_eigenrays(const BruteSea& sea, const RayLink& link, double steepest_rad,
                                           int count);

// The ray launched at `launch_rad`, if it passes within a millimetre of the receiver.
std::optional<BruteEigenray> brute_eigenray(const BruteSea& sea, const RayLink& link, double launch_rad);

}  // namespace halocline::acoustics
