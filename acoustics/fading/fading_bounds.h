// SPDX-License-Identifier: BSD-3-Clause
// Bounds of what any link of a mean ratio delivers, however it fades: by which links that deliver nothing are
// recognised before anything of them is computed.
//
// A power that sums many paths is spread most where it is one that is wholly scattered: exponentially
// distributed. Large-scale fading multiplies it by 10^(X/10), X normal. Both are divided into intervals of
// which the upper end counts.
#pragma once

#include <numbers>

#include "acoustics/fading/path_fading.h"
#include "acoustics/math/functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {

// The mean of `chance`, 0..1 and rising with the ratio, over an exponentially distributed one.
template <typename Chance>
double most_over_rayleigh_fading(double mean_sinr, Chance chance) {
  constexpr int kIntervals = 14;  // of one mean each; what is beyond counts as certain
  double most = elementary::exp(-static_cast<double>(kIntervals));
  for (int i = 0; i < kIntervals; ++i) {
    const double share = elementary::exp(-static_cast<double>(i)) - elementary::exp(-(i + 1.0));
    most += share * chance(mean_sinr * (i + 1));
  }
  return most;
}

// Over large-scale fading as well, whose mean is 1; without fading, the chance itself.
template <typename Chance>
double most_over_fading(const FadingModel& model, double mean_sinr, Chance chance) {
  if (!model.enabled) return chance(mean_sinr);
  if (!(model.large_scale_db > 0)) return most_over_rayleigh_fading(mean_sinr, chance);
  constexpr double kStep = 0.25, kMost = 5;  // standard deviations; what is beyond (3e-7) counts as certain
  const double deviation = std::numbers::ln10 / 10 * model.large_scale_db;
  double most = 1 - normal_probability(kMost), below = 0;
  for (double z = -kMost + kStep; z <= kMost; z += kStep) {
    const double louder = elementary::exp(deviation * z - deviation * deviation / 2);
    most += (normal_probability(z) - below) * most_over_rayleigh_fading(mean_sinr * louder, chance);
    below = normal_probability(z);
  }
  return most;
}

// The mean ratio, -80..60 dB, below which `bound(mean ratio)`, which rises with it, is less than `least`.
template <typename Bound>
double least_mean_db(double least, Bound bound) {
  double low_db = -80, high_db = 60;
  while (high_db - low_db > 0.01) {
    const double middle_db = (low_db + high_db) / 2;
    (bound(elementary::exp10(middle_db / 10)) < least ? low_db : high_db) = middle_db;
  }
  return low_db;
}

}  // namespace halocline::acoustics
