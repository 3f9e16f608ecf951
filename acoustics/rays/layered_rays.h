// SPDX-License-Identifier: BSD-3-Clause
// Eigenrays between two points of water that depends on depth alone, over a flat bottom.
//
// Method. Each of the four families of acoustics/rays/arcs/layered_legs.h solves
//   b(xi) + n X(xi) = r,
// with X the range of one whole cycle and n the number of whole cycles. The function f = (r - b) / X is
// tabulated between consecutive barriers against the grazing angle at the barrier, in which it is smooth.
// Wherever f crosses a whole number n >= 0 there is a ray of n cycles. A turn of f, which is a fold caustic
// of two rays, is located first and splits the interval. The table is refined until a cubic through values
// and slopes predicts f; Newton's method on f then gives the ray. The delay is xi r + (tau - xi r), whose
// error is of second order in the remaining error of the range. The amplitude follows from dr/dxi in closed
// form,
//   A^2 = c_s c_r / ((r / xi) |dr/dxi| sin_s sin_r),
// which is symmetric in the two ends. A ray of m turns in the water has touched m - 1 caustics, and one more
// when dr/dxi > 0. At a fold the field is that of acoustics/math/fold_field.h; at barriers that rays pass
// smoothly it is that of acoustics/math/turning_field.h. At the other barriers a family ends.
//
// Accuracy: exact for the given knots (delays to 1e-9 s). Neglected: diffraction into shadows other than
// those of caustics, beam displacement at the bottom, rays within the core of a channel.
#pragma once

#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A flat sea: the water, its two boundaries and the options of the search. It refers to the water, which has
// to outlive the call.
struct FlatSea {
  const RayWater& water;
  double bottom_depth_m;  // 0.1..12 000
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  double core_speed_mps = 0;  // rays that nowhere exceed it are left out: acoustics/rays/channel_core.h
};

// Returns all eigenrays of `link`. Its depths lie within 0..bottom_depth_m; an end at a boundary is moved off
// it by a micrometre.
std::vector<Eigenray> layered_rays(const FlatSea& sea, const RayLink& link);

}  // namespace halocline::acoustics
