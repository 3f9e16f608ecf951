// SPDX-License-Identifier: BSD-3-Clause
// Extrapolates the arrivals of one link to another whose ends lie a little off, to first order: microseconds
// a link.
//
// Model: the travel time's gradient is exact (Fermat): it grows by sin / c of the arrival angle per metre
// that the receiver goes down, falls by that of the launch angle per metre of the source, and grows with the
// range, when the bottom legs along with it, by the mean of cos / c over the range. The wave front that comes
// in is taken for a sphere about the source as the path unfolds it, of radius path length L: with a
// displacement of which w lies across the ray, tau' = sqrt((tau + gradient)^2 + (w / c)^2), c = L / tau.
// Length and absorption grow as tau does, pressure falls so, but not within 1 m of the source; both angles
// turn as that sphere's rays do.
//
// Exact in water of one speed over a level bottom. Else delays err by the square of the displacement d: below
// d^2 / (c L) away from caustics; levels and angles by the first power, d / L, as focusing and bounces stay
// those of the link that was searched. Where the bottom's slope is smoothed (acoustics/sea/bottom_profile.h),
// its bends take part in the first power as well. Left out: paths that exist for one of the two links alone.
//
// Pure: calls may overlap between threads.
#pragma once

#include <vector>

#include "acoustics/rays/arrivals.h"

namespace halocline::acoustics {

// Sound speeds, m/s, at the ends of the link that was searched.
struct EndSpeeds {
  double source_mps = 0, receiver_mps = 0;
};

// `found` are the arrivals of `from`; the result is those of `to` in the order of their delays.
std::vector<Arrival> extrapolate_arrivals(const std::vector<Arrival>& found, const RayLink& from,
                                          const EndSpeeds& speeds, const RayLink& to);

}  // namespace halocline::acoustics
