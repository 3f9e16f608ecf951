// SPDX-License-Identifier: BSD-3-Clause
// Eigenrays: the paths of sound between two points, by one of three exact solvers.
//
//   const RayOptions options{.frequency_hz = 11'520};
//   const RaySea sea{ray_water(environment, options.frequency_hz), BottomProfile::flat(100),
//   *sediment("MediumSand"),
//                    RaySurface{.wind_mps = 5}, options};
//   const Arrivals found = arrivals(sea, {.source_depth_m = 30, .receiver_depth_m = 50, .range_m = 2000});
//   for (const Arrival& path : found.paths) std::cout << path.delay_s << ' ' << path.received_pressure() <<
//   '\n'; if (found.shadow()) std::cout << "no ray gets there\n";
//
// Solvers: images (one sound speed, flat bottom: acoustics/rays/image_rays.h), Snell (water of depth alone,
// flat bottom: acoustics/rays/layered_rays.h), arcs (any bottom profile: acoustics/rays/profile_rays.h). The
// simplest that is exact is chosen; the user may name one instead. All are exact for the knots and facets
// given; what each leaves out is in its header.
//
// Values, immutable: calls may overlap between threads. A link between two vehicles is searched from the
// transmitter to the receiver; the other way has the same delays and amplitudes (with launch and arrival
// angles exchanged and turned), but which rays the limit on the launch angle drops depends on the end they
// leave from.
#pragma once

#include <memory>
#include <optional>

#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/traced_ray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_section.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// What rays depend on, along one link: ranges of the profile are from the source.
struct RaySea {
  RayWater water;
  BottomProfile bottom_profile;
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  // Water that changes along the link, whose first column is `water`; null: water of depth alone.
  std::shared_ptr<const RaySection> section = nullptr;
};

// The water of an environment at a frequency, Hz: 50 us for a profile of 15 rows, so keep it. With a
// tolerance above 0, m/s, those of its knots are left out that linear interpolation between the others meets
// to within it.
RayWater ray_water(const Environment& environment, double frequency_hz, double thinning_tolerance_mps = 0);

// The simplest solver that is exact for this link.
RaySolver choose_solver(const RaySea& sea, const RayLink& link);

// All paths; none in a shadow zone, which is no error. Where no path is strong enough for the limits on
// bounces, they are widened until there is one, to 250 dB of loss; why there is none in the end is found by
// one more search. Depths of the link have to lie between surface and bottom, each at its range
// (InvalidArgument otherwise), and the solver named has to be able to do it: images and Snell refuse what
// they would get wrong. Between ends nearer than 1 m sound takes as long as the distance asks for, at the
// level of 1 m.
// Links from one end that share rays (acoustics/rays/column_rays.h, bearing_rays.h) do so where the solver is
// arcs; the sea has to outlive them.
Arrivals arrivals(const RaySea& sea, const RayLink& link, std::optional<RaySolver> solver = std::nullopt,
                  SharedRays* shared = nullptr);

}  // namespace halocline::acoustics
