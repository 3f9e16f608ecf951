// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/delay_profile.h"

#include <cmath>

#include "acoustics/math/functions.h"

namespace halocline::acoustics {

// Moments about the first delay, which keeps digits that the squares of absolute delays would lose:
//   mean = sum of P t / sum of P,  spread^2 = sum of P (t - mean)^2 / sum of P
DelayMoments delay_moments(const std::vector<WeightedDelay>& paths) {
  if (paths.empty()) return {};
  const double first_s = paths.front().delay_s;
  double power = 0, first = 0, second = 0;
  for (const auto& [delay_s, weight] : paths) {
    power += weight;
    first += weight * (delay_s - first_s);
  }
  if (!(power > 0)) return {first_s, 0};
  const double mean = first / power;
  for (const auto& [delay_s, weight] : paths) second += weight * squared(delay_s - first_s - mean);
  return {first_s + mean, std::sqrt(second / power)};
}

}  // namespace halocline::acoustics
