// SPDX-License-Identifier: BSD-3-Clause
// Rays that links from one end share, in the place of a search for each.
#pragma once

#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/traced_ray.h"

namespace halocline::acoustics {

// One for each line of links; not shared between threads.
class SharedRays {
 public:
  virtual ~SharedRays() = default;
  // The paths of a link, as profile_rays(). From call to call only the receiver and the options change; what the sea of the first refers
  // to outlives this.
  virtual std::vector<Arrival> at(const ProfiledSea& sea, const RayLink& link) = 0;
};

// With what bounces may leave in steps of 10 dB, so that receivers whose strongest paths lose about as much share a fan.
RayOptions widened(RayOptions options);
// Drops paths whose bounces leave less than the options allow.
void drop_faint(std::vector<Arrival>& paths, const RayOptions& options);

}  // namespace halocline::acoustics
