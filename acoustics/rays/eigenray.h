// The paths of sound between two points: one question, behind which stand three exact solvers.
//
//   const RaySea sea = ray_sea(environment, BottomProfile::flat(100), *sediment("MediumSand"),
//   SurfaceModel::kAplBubbles,
//                              RayOptions{});
//   const Arrivals found = arrivals(sea, {.source_depth_m = 30, .receiver_depth_m = 50, .range_m = 2000});
//   if (found.shadow()) ...;  // no ray gets there: an answer, not an error
//
// Solvers: images (one sound speed, flat bottom: acoustics/rays/image_rays.h), Snell (water of depth alone, flat
// bottom: acoustics/rays/layered_rays.h), arcs (any bottom profile: acoustics/rays/profile_rays.h). The simplest that
// is exact is chosen; the user may name one instead. All are exact for the knots and facets given; what each
// leaves out its header says.
//
// Values, immutable: calls may overlap between threads. A link between two vehicles asks from the transmitter
// to the receiver; the other way has the same delays and amplitudes (with launch and arrival angles exchanged
// and turned), but which rays the limit on the launch angle drops depends on the end they leave from.
#pragma once

#include <optional>

#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/ray_water.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "core/frames.h"

namespace halocline::acoustics {

// The sea as rays see it, along one link: ranges of the profile are from the source.
struct RaySea {
  RayWater water;
  BottomProfile bottom_profile;
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
};

// Water of an environment at the frequency of `options`; its wind roughens the surface in the form of
// `surface`. Throws InvalidArgument when a part is out of range. About 50 us for a profile of 15 rows: keep
// it.
RaySea ray_sea(const Environment& environment, BottomProfile bottom_profile, const FluidBottom& bottom,
               SurfaceModel surface, const RayOptions& options);
// Its water alone, to be shared by links over different bottoms. With a tolerance above 0, m/s, those of its knots
// are left out that the straight line between others says to that.
RayWater ray_water(const Environment& environment, double frequency_hz, double thinning_tolerance_mps = 0);

// The simplest solver that is exact for this link.
RaySolver choose_solver(const RaySea& sea, const RayLink& link);

// All paths. Depths of the link have to lie between surface and bottom, each at its range (InvalidArgument
// otherwise), and the solver named has to be able to do it: images and Snell refuse what they would get
// wrong.
Arrivals arrivals(const RaySea& sea, const RayLink& link, std::optional<RaySolver> solver = std::nullopt);

// The same for positions in the NED world frame, m; the profile starts at the source and runs towards the
// receiver.
Arrivals arrivals(const RaySea& sea, const Vec3& source_ned_m, const Vec3& receiver_ned_m,
                  double sea_surface_z_m);

// Depths and horizontal distance of two positions.
RayLink ray_link(const Vec3& source_ned_m, const Vec3& receiver_ned_m, double sea_surface_z_m);

// The same link after its ends moved a little (up to some metres): the paths of `before` are followed to
// where they are now by Newton's method, which costs a fraction of a search. One that cannot be followed (it
// ended at a fold or an edge) is dropped; where such paths carried 1 % of the power, the arcs solver looks
// about where they were, and the others search for all again. Paths that came into being elsewhere are not
// found: search afresh once the ends have moved by some metres.
Arrivals follow(const RaySea& sea, const RayLink& link, const Arrivals& before);

}  // namespace halocline::acoustics
