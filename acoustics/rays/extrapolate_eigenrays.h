// SPDX-License-Identifier: BSD-3-Clause
// Extrapolates the eigenrays of one link to another whose ends are slightly displaced, to first order; it
// takes microseconds per link.
//
// Model. The gradient of the travel time is exact (Fermat's principle). The travel time grows by sin / c of
// the arrival angle per metre that the receiver descends, falls by sin / c of the launch angle per metre that
// the source descends, and grows per metre of range, if the bottom moves along with the receiver, by the mean
// of cos / c over the range. The incoming wavefront is taken as a sphere about the source, as the unfolded
// path sees it, with the path length L as its radius. For a displacement with the component w across the ray,
//   tau' = sqrt((tau + gradient)^2 + (w / c)^2),  c = L / tau.
// Length and absorption grow in proportion to tau, and pressure falls in proportion, except within 1 m of the
// source. Both angles turn like the rays of that sphere.
//
// Error. The result is exact in water of one sound speed over a level bottom. Otherwise delays err by the
// square of the displacement d, less than d^2 / (c L) away from caustics. Levels and angles err by the first
// power, d / L, because focusing and bounces remain those of the original link. Where the bottom's slope is
// smoothed (acoustics/sea/bottom_profile.h), its bends add an error of first power too. Neglected: paths that
// exist for only one of the two links.
//
// Thread rule: pure functions, which threads may call at the same time.
#pragma once

#include <vector>

#include "acoustics/rays/eigenray.h"

namespace halocline::acoustics {

// Sound speeds, m/s, at the ends of the original link.
struct EndSpeeds {
  double source_mps = 0, receiver_mps = 0;
};

// Returns the eigenrays of `to` in the order of their delays, given the eigenrays `found` of the link `from`.
std::vector<Eigenray> extrapolate_eigenrays(const std::vector<Eigenray>& found, const RayLink& from,
                                            const EndSpeeds& speeds, const RayLink& to);

}  // namespace halocline::acoustics
