// SPDX-License-Identifier: BSD-3-Clause
// The core of a sound channel: what lies within its lowest mode, where rays of the water stand for nothing.
//
// Model. Between its two turning depths a ray of greatest speed c* (its xi is 1 / c*) gathers in one loop the
// phase
//   J(c*) = 2 omega integral of sqrt(1/c^2 - 1/c*^2) dz,
// and modes have J = 2 pi (n - 1/2) (Jensen and others 2011, section 2.4: the WKB approximation). Rays of J <
// pi swing less than the lowest mode. At a kink of a tabulated profile there are any number of them, each as
// strong as a spherical wave. A link with both ends within has one axial ray in their place, with the tube of
// the parabolic channel that has the same J and the same height H between the turning depths:
//   c = c0 (1 + kappa^2 z^2 / 2),  kappa = 4 J c0 / (pi omega H^2),  q = sin(kappa r) / kappa,
// |sin| at least 1/2 beyond a quarter of a loop, where the focus is as wide as the mode (2 kappa / r is the
// power of the lowest mode on the axis). A channel that reaches surface or bottom before J = pi ends there.
//
// Error: the delay is that of the mean speed at both ends, 1 / omega or less off. Free functions on values:
// calls may overlap between threads.
#pragma once

#include <optional>

#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

struct ChannelCore {
  double greatest_speed_mps;  // c* of its widest ray
  double kappa_per_m;
};

// That of both ends of a link in water `bottom_m` deep or deeper; empty where rays between them are resolved.
std::optional<ChannelCore> channel_core(const RayWater& water, double bottom_m, const RayLink& link,
                                        double frequency_hz);

// The axial ray; range of the link above 0.
Arrival axial_ray(const RayWater& water, const ChannelCore& core, const RayLink& link);

// Whether a path runs within the core from end to end.
inline bool runs_within(const ChannelCore& core, const Arrival& path) {
  return path.surface_bounces + path.bottom_bounces == 0 &&
         path.launch_slowness_spm * core.greatest_speed_mps > 1;
}

}  // namespace halocline::acoustics
