// SPDX-License-Identifier: BSD-3-Clause
// Every ray between two points of layered water over a bottom that changes with range.
//
// Method: a fan of exactly traced rays (acoustics/rays/arc_tracer.h). Between two neighbours of the same history
// the unfolded depth zeta(theta) at the receiver's range is smooth but for bends of the water's profile; each
// cell is halved until a cubic through values and slopes predicts its middle. Every image of the receiver,
// +-z + 2 H k, that lies between two rays is a bracket; a turn of zeta (a fold) is sought first and split at.
// Histories that part (a ray that grazes the surface or a crest, or meets the other side of a corner) part
// the cell there, by bisection; between rays that do not arrive it is halved five times where their histories differ.
// Newton with the ray tube polishes; what is left of the depth is taken off the
// delay to first order, so delays err by its square. Amplitude A^2 = c_r cos_s / (c_s r |q|) times the
// bounces; at a fold the field is that of acoustics/math/fold_field.h.
//
// Accuracy: exact for knots and facets given. Left out: rays that turn back, slopes across the link,
// diffraction but that of caustics.
#pragma once

#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/traced_ray.h"

namespace halocline::acoustics {

// All rays of `link`; depths between the surface and the bottom at both ends (at a boundary: a micrometre off
// it).
std::vector<Arrival> profile_rays(const ProfiledSea& sea, const RayLink& link);

}  // namespace halocline::acoustics
