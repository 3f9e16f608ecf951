// SPDX-License-Identifier: BSD-3-Clause
// Paths of a link whose ends move from packet to packet by platform jitter.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/prediction/platform_jitter.h"
#include "core/random.h"

namespace halocline::channel_server::testing {

// Platform jitter moves the ends (acoustics/prediction/platform_jitter.h): phases of the paths as packet `i`
// meets them.
inline std::vector<acoustics::Arrival> jittered(std::vector<acoustics::Arrival> paths, double frequency_hz,
                                                std::uint64_t i) {
  const auto jitter_m = [&](std::uint64_t end) {
    return acoustics::kPlatformJitterM *
           normal_at({.seed = end, .purpose = purpose_of("test-sway"), .which = i});
  };
  const double turn_per_m = 2 * std::numbers::pi * frequency_hz / 1500, from_m = jitter_m(1),
               to_m = jitter_m(2);
  for (acoustics::Arrival& path : paths) {
    path.phase_rad +=
        turn_per_m * (from_m * std::sin(path.launch_angle_rad) + to_m * std::sin(path.arrival_angle_rad));
  }
  return paths;
}

}  // namespace halocline::channel_server::testing
