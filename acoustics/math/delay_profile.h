// SPDX-License-Identifier: BSD-3-Clause
// Moments of a delay profile: when the power of many paths arrives.
#pragma once

#include <vector>

namespace halocline::acoustics {

struct WeightedDelay {
  double delay_s, power;  // power in any unit, at least 0
};

struct DelayMoments {
  double mean_s = 0;    // sum of P t / sum of P; the first delay where there is no power
  double spread_s = 0;  // rms about it, s^2 = sum of P (t - mean)^2 / sum of P
};

// Of no path: zeros.
DelayMoments delay_moments(const std::vector<WeightedDelay>& paths);

}  // namespace halocline::acoustics
