// SPDX-License-Identifier: BSD-3-Clause
// Moments of a delay profile: mean delay and delay spread of the power of many paths.
#pragma once

#include <vector>

namespace halocline::acoustics {

struct WeightedDelay {
  double delay_s, power;  // power in any unit, >= 0
};

struct DelayMoments {
  // Sum of P t / sum of P; the first delay when the power is 0.
  double mean_s = 0;
  double spread_s = 0;  // rms about the mean: s^2 = sum of P (t - mean)^2 / sum of P
};

// The moments of `paths`; zeros for an empty list.
DelayMoments delay_moments(const std::vector<WeightedDelay>& paths);

}  // namespace halocline::acoustics
