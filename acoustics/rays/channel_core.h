// SPDX-License-Identifier: BSD-3-Clause
// The core of a sound channel: the region within its lowest mode, where rays have no physical meaning.
//
// Model. Between its two turning depths a ray of greatest speed c* (xi = 1 / c*) gathers in one loop the
// phase
//   J(c*) = 2 omega integral of sqrt(1/c^2 - 1/c*^2) dz,
// and modes have J = 2 pi (n - 1/2) (Jensen and others 2011, section 2.4: the WKB approximation). Rays with
// J < pi oscillate less than the lowest mode. At a kink of a tabulated profile there is any number of them,
// each as strong as a spherical wave. For a link with both ends inside the core, one axial ray replaces them.
// Its tube is that of the parabolic channel with the same J and the same height H between the turning depths:
//   c = c0 (1 + kappa^2 z^2 / 2),  kappa = 4 J c0 / (pi omega H^2),  q = sin(kappa r) / kappa.
// Beyond a quarter of a loop |sin| is at least 1/2: the focus is as wide as the mode (2 kappa / r is the
// power of the lowest mode on the axis). A channel that reaches surface or bottom before J = pi ends there.
//
// Error: the delay is that of the mean speed of both ends, off by at most 1 / omega.
//
// Thread rule: free functions on values, which threads may call at the same time.
#pragma once

#include <optional>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

struct ChannelCore {
  double greatest_speed_mps;  // c* of its widest ray
  double kappa_per_m;         // kappa of the parabolic channel, 1/m
};

// The core that contains both ends of a link in water at least `bottom_m` deep; empty when the rays between
// them are resolved.
std::optional<ChannelCore> channel_core(const RayWater& water, double bottom_m, const RayLink& link,
                                        double frequency_hz);

// The axial ray; the range of the link has to be above 0.
Eigenray axial_ray(const RayWater& water, const ChannelCore& core, const RayLink& link);

// True when a path runs within the core from end to end.
inline bool runs_within(const ChannelCore& core, const Eigenray& path) {
  return path.surface_bounces + path.bottom_bounces == 0 &&
         path.launch_slowness_spm * core.greatest_speed_mps > 1;
}

}  // namespace halocline::acoustics
