// SPDX-License-Identifier: BSD-3-Clause
// Eigenrays: the paths of sound between two points, found by one of three exact solvers.
//
//   const RayOptions options{.frequency_hz = 11'520};
//   const RaySea sea{ray_water(environment, options.frequency_hz), BottomProfile::flat(100),
//                    *sediment("MediumSand"), RaySurface{.wind_mps = 5}, options};
//   const Eigenrays found = eigenrays(sea, {.source_depth_m = 30, .receiver_depth_m = 50, .range_m = 2000});
//   for (const Eigenray& path : found.paths)
//     std::cout << path.delay_s << ' ' << path.received_pressure() << '\n';
//   if (found.shadow()) std::cout << "no ray gets there\n";
//
// Solvers:
// - images: one sound speed, flat bottom (acoustics/rays/image_rays.h);
// - Snell: water that depends on depth alone, flat bottom (acoustics/rays/layered_rays.h);
// - arcs: any bottom profile (acoustics/rays/profile_rays.h).
//
// The simplest solver that is exact for a link is chosen unless the caller names one. All are exact for the
// given knots and facets; the header of each states what it neglects.
//
// A link between two vehicles is searched from the transmitter to the receiver. The reverse link has the same
// delays and amplitudes, with launch and arrival angles exchanged and reversed, but the limit on the launch
// angle may drop other rays, because it applies at the end from which they leave.
//
// Thread rule: immutable values; threads may call at the same time.
#pragma once

#include <memory>
#include <optional>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_section.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// The sea along one link, with all that rays depend on. Ranges of the profile are measured from the source.
struct RaySea {
  RayWater water;
  BottomProfile bottom_profile;
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  // Water that changes along the link and whose first column is `water`; null: the water depends on depth
  // alone.
  std::shared_ptr<const RaySection> section = nullptr;
};

// The water of an environment at a frequency, Hz. It takes 50 us for a profile of 15 rows, so callers should
// keep it. A tolerance above 0, m/s, thins the profile: knots are left out that linear interpolation between
// the others matches to within the tolerance.
RayWater ray_water(const Environment& environment, double frequency_hz, double thinning_tolerance_mps = 0);

// The simplest solver that is exact for this link.
RaySolver choose_solver(const RaySea& sea, const RayLink& link);

// Returns all paths of a link; none in a shadow zone, which is not an error. When no path is strong enough
// for the limits on bounces, the limits are widened until one is, up to 250 dB of loss; when there is none in
// the end, one more search finds the reason (Eigenrays::lack).
//
// Throws InvalidArgument unless the depths of the link lie between surface and bottom, each at its range, and
// a solver that is named is exact for the link: images and Snell refuse other seas. Between ends closer than
// 1 m the delay is that of the true distance and the level that at 1 m.
//
// Links with one common end can share rays through `shared` (acoustics/rays/depth_fan.h, range_fan.h),
// which takes effect when the solver is arcs. The sea then has to outlive `shared`.
Eigenrays eigenrays(const RaySea& sea, const RayLink& link, std::optional<RaySolver> solver = std::nullopt,
                    SharedRays* shared = nullptr);

}  // namespace halocline::acoustics
