// The energy of a weak link over a rough bottom, whose rays are not worth tracing.
//
// Model: that of acoustics/rays/diffuse_windows.h for all rays, in water of the mean depth between the ends. A ray of Snell's
// xi goes up and down between where it turns, or meets surface and bottom, half a cycle D(xi) long; over the range r it does
// so r / D times, and loses each time what the boundaries take, f in all. The launch angles dtheta bring the power
//   f^2 cot(angle at the receiver) / D dtheta / r
// with the delay, length and absorption of r / D half cycles. Each window is one Arrival, diffuse.
//
// Accuracy: over bottoms with 5 m of relief, 2 to 6 km apart, 1 dB in the mean over places of what every ray brings, 3 dB rms
// from place to place; some thirty microseconds. Left out: what stands in the way, and slopes.
#pragma once

#include <optional>
#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// Refers to the water, which has to outlive the call.
struct MixedSea {
  const RayWater& water;
  double depth_m;  // mean between the ends
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
};

// The windows that hold 99 % of the power, by delay; none where no ray that leaves the source comes to the receiver's depth.
std::vector<Arrival> mixed_arrivals(const MixedSea& sea, const RayLink& link);

// The same of a link that is weak: more than 10 depths long, all of it, and a direct path alone, 6 dB below
// RayOptions::diffuse_below_pressure. Empty for others.
std::optional<std::vector<Arrival>> weak_arrivals(const MixedSea& sea, const RayLink& link);

}  // namespace halocline::acoustics
