// SPDX-License-Identifier: BSD-3-Clause
// Every ray between two points of water that depends on depth alone, over a flat bottom.
//
// Method: the four families of acoustics/rays/arcs/layered_legs.h each solve b(xi) + n X(xi) = r, X one whole
// cycle. So f = (r - b)/X is tabulated between consecutive barriers against the grazing angle at the barrier,
// in which it is smooth; wherever f crosses a whole number n >= 0 there is a ray of n cycles, and a turn of f
// (a fold, the caustic of two rays) is found first and split at. The table is refined until a cubic through
// values and slopes predicts it. Newton on f polishes. Delay is xi r + (tau - xi r), which errs by the square
// of what is left of the range. Amplitude from dr/dxi in closed form,
//   A^2 = c_s c_r / ((r / xi) |dr/dxi| sin_s sin_r),
// which is the same with the ends swapped. A ray of m turns in the water has touched m - 1 caustics, and one
// more when dr/dxi > 0. At a fold the field is that of acoustics/math/fold_field.h;
// at barriers that rays pass smoothly, that of acoustics/math/turning_field.h. A family ends at the others.
//
// Accuracy: exact for the knots given (delays to 1e-9 s). Left out: diffraction into shadows beyond caustics'
// own, beam displacement at the bottom, rays within the core of a channel.
#pragma once

#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A flat sea: water, its two boundaries and what to look for. Refers to the water, which has to outlive the
// call.
struct FlatSea {
  const RayWater& water;
  double bottom_depth_m;  // 0.1..12 000
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  double core_speed_mps = 0;  // rays that nowhere go faster are left out: acoustics/rays/channel_core.h
};

// All rays of `link`, whose depths are within 0..bottom_depth_m (at a boundary: a micrometre off it).
std::vector<Arrival> layered_rays(const FlatSea& sea, const RayLink& link);

}  // namespace halocline::acoustics
