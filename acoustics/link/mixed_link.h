// SPDX-License-Identifier: BSD-3-Clause
// The energy of a weak link over a rough bottom, whose rays are not worth tracing.
//
// Model: that of acoustics/rays/diffuse_windows.h for all rays, in water of the mean depth between the ends.
// A ray of Snell's xi goes up and down between where it turns, or meets surface and bottom, half a cycle
// D(xi) long; over the range r it does so r / D times, and loses each time what the boundaries take, f in
// all. The launch angles dtheta bring the power
//   f^2 cot(angle at the receiver) / D dtheta / r
// with the delay, length and absorption of r / D half cycles. Where the bottom has slopes, these turn the
// rays at every bounce: the power of those that meet it is that of acoustics/link/slope_diffusion.h, by their
// angles at the bottom. Each window is one Arrival, diffuse.
//
// Accuracy: over bottoms with 5 m of relief, 2 to 5 km apart, 0.6 dB in the mean over places of what every
// ray brings, 2 dB rms from place to place; some fifty microseconds. Left out: what stands in the way, and
// slopes that go on over the whole link.
#pragma once

#include <optional>
#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "core/units.h"

namespace halocline::acoustics {

// Refers to the water, which has to outlive the call.
struct MixedSea {
  const RayWater& water;
  double depth_m;  // mean between the ends
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  double mean_square_slope = 0;  // of the bottom along the link, beside its mean slope
};

// The windows that hold 99 % of the power, by delay; none where no ray that leaves the source comes to the
// receiver's depth.
std::vector<Arrival> mixed_arrivals(const MixedSea& sea, const RayLink& link);

// The same of a link that is weak: more than 10 depths long, all of it, and a direct path alone, `below`
// under RayOptions::diffuse_below_pressure. Empty for others.
std::optional<std::vector<Arrival>> weak_arrivals(const MixedSea& sea, const RayLink& link, Decibels below);
// Whether it is weak over some bottom: its direct path alone is.
bool may_be_weak(const RayWater& water, const RayOptions& options, const RayLink& link, Decibels below);

// The least that weak links lose, wherever their ends and their bottom lie: a bound by which those that
// cannot matter are recognised before anything of them is computed.
//
// The energy of mixed rays is greatest at some depths of both ends and of the bottom, among kEnds and
// kBottoms of each, evenly spread (0.3 dB less than between them in a summer's thermocline). A weak link over
// an uneven bottom has that energy. Over an even one its rays are traced: `gain` is what they may have beside
// the mean (least_loss.h).
class LeastMixedLoss {
 public:
  struct Depths {
    double least_m, greatest_m;  // of the water between the ends, mean; above 0, rising
    double deepest_end_m;        // above 0
  };
  // Makes 2 ms of work. `depth_m` of the sea is not used.
  LeastMixedLoss(const MixedSea& sea, const Depths& depths, Decibels gain);

  // At `range_m` > 0; it rises with range.
  Decibels at(double range_m) const;
  // All links that are longer lose more than `loss`, where links with less energy than `weak_loss` leaves are
  // weak. Infinite where less is asked for.
  double range_of(Decibels loss, Decibels weak_loss) const;

 private:
  // The power of a window over the range r is power_m / r exp(-nepers_per_m r).
  struct Window {
    double power_m, nepers_per_m;
  };
  double shortest_m_;                 // no weak link is shorter
  double least_absorption_db_per_m_;  // where an end may be
  Decibels gain_;
  std::vector<std::vector<Window>> links_;
};

}  // namespace halocline::acoustics
