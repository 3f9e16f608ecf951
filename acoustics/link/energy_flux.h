// SPDX-License-Identifier: BSD-3-Clause
// Incoherent energy flux (Weston 1971) of a flux-only link: one over a rough bottom that is too weak to be
// worth tracing rays for. It serves seas whose scattered sound keeps its angle (scattering = "none"); where
// sound turns, the windows of acoustics/scattering replace it, and it bounds their loss.
//
// Model: that of acoustics/rays/diffuse_windows.h for all rays, in water of the mean depth between the ends.
// A ray of Snell's invariant xi alternates between the points where it turns, or meets surface and bottom;
// D(xi) is the length of such a half cycle. Over the range r there are r / D half cycles, with the boundary
// loss of each; f is the product of all of them in pressure. The launch angles dtheta contribute the power
//   f^2 cot(angle at the receiver) / D dtheta / r
// with the delay, length and absorption of r / D half cycles. Each window of launch angles is one eigenray,
// marked diffuse.
//
// Accuracy: over bottoms with 5 m of relief, ends 2 to 5 km apart, the mean over places is within 0.6 dB of
// tracing every ray, 2 dB rms from place to place; cost some fifty microseconds. Left out: terrain that
// blocks the link, and slopes that persist over the whole link.
#pragma once

#include <optional>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "core/units.h"

namespace halocline::acoustics {

// The sea along a link. Refers to the water, which must outlive the call.
struct EnergyFluxSea {
  const RayWater& water;
  double depth_m;  // mean depth between the ends
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
};

// The windows that have 99 % of the power, sorted by delay; empty when no ray that leaves the source reaches
// the receiver's depth.
std::vector<Eigenray> energy_flux_eigenrays(const EnergyFluxSea& sea, const RayLink& link);

// The windows of a link that is weak: longer than 10 depths, with its total power and that of its direct path
// each at least `below` under RayOptions::diffuse_below_pressure. nullopt for other links.
std::optional<std::vector<Eigenray>> flux_only_eigenrays(const EnergyFluxSea& sea, const RayLink& link,
                                                         Decibels below);
// True when the link may be weak over some bottom: its direct path alone is.
bool may_be_flux_only(const RayWater& water, const RayOptions& options, const RayLink& link, Decibels below);

// Lower bound of the loss of flux-only links for any depths of ends and bottom, by which links that cannot
// matter are recognised before anything of them is computed.
//
// The energy flux is greatest at certain depths of both ends and of the bottom; the bound takes the greatest
// over kEnds and kBottoms evenly spaced ones (0.3 dB less than between them in a summer's thermocline). A
// flux-only link over an uneven bottom has that energy. Over an even bottom its rays are traced: `gain` is
// how much they may exceed the mean (least_loss.h).
class LeastFluxLoss {
 public:
  struct Depths {
    double least_m, greatest_m;  // mean water depth between the ends; above 0, ascending
    double deepest_end_m;        // above 0
  };
  // Takes 2 ms. `depth_m` of the sea is not used.
  LeastFluxLoss(const EnergyFluxSea& sea, const Depths& depths, Decibels gain);

  // Bound at `range_m` > 0; it rises with range.
  Decibels at(double range_m) const;
  // The range beyond which every link loses more than `loss`, given that links with more loss than
  // `flux_only_loss` are weak. Infinite when `loss` is below `flux_only_loss`.
  double range_of(Decibels loss, Decibels flux_only_loss) const;

 private:
  // The power of a window over the range r is power_m / r exp(-nepers_per_m r).
  struct Window {
    double power_m, nepers_per_m;
  };
  double shortest_m_;                 // flux-only links are longer
  double least_absorption_db_per_m_;  // over the depths of the ends
  Decibels gain_;
  std::vector<std::vector<Window>> links_;
};

}  // namespace halocline::acoustics
