// SPDX-License-Identifier: BSD-3-Clause
// Upper bounds of the delivery probability of a link with a given mean SINR, whatever its fading. Links that
// deliver nothing are recognised by them before anything else of the link is computed.
//
// Among all sums of paths, the power has the widest distribution when it is a single path that is wholly
// scattered: the exponential distribution. Large-scale fading multiplies it by 10^(X/10) with X normal; slow
// fading counts as a part of X, so that the bounds hold on average over days. Both distributions are divided
// into intervals, each evaluated at its upper end.
#pragma once

#include <numbers>

#include "acoustics/fading/path_fading.h"
#include "acoustics/math/functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {

// Upper bound of the mean of `chance(SINR)`, a function that rises with the SINR from 0 to 1, over an
// exponential distribution of the SINR.
template <typename Chance>
double most_over_rayleigh_fading(double mean_sinr, Chance chance) {
  constexpr int kIntervals = 14;  // each as wide as the mean; `chance` counts as 1 beyond them
  double most = elementary::exp(-static_cast<double>(kIntervals));
  for (int i = 0; i < kIntervals; ++i) {
    const double share = elementary::exp(-static_cast<double>(i)) - elementary::exp(-(i + 1.0));
    most += share * chance(mean_sinr * (i + 1));
  }
  return most;
}

// Upper bound over large-scale fading of mean 1 as well; without fading, `chance` itself.
template <typename Chance>
double most_over_fading(const FadingModel& model, double mean_sinr, Chance chance) {
  if (!model.enabled) return chance(mean_sinr);
  const double deviation_db =
      model.slow.any() ? elementary::hypot(model.large_scale_db, model.slow.rms_db()) : model.large_scale_db;
  if (!(deviation_db > 0)) return most_over_rayleigh_fading(mean_sinr, chance);
  // Step and limit in standard deviations; `chance` counts as 1 beyond them (probability 3e-7).
  constexpr double kStep = 0.25, kMax = 5;
  const double deviation = std::numbers::ln10 / 10 * deviation_db;
  double most = 1 - normal_probability(kMax), below = 0;
  for (double z = -kMax + kStep; z <= kMax; z += kStep) {
    const double louder = elementary::exp(deviation * z - deviation * deviation / 2);
    most += (normal_probability(z) - below) * most_over_rayleigh_fading(mean_sinr * louder, chance);
    below = normal_probability(z);
  }
  return most;
}

// The mean SINR, -80..60 dB, below which `bound(mean SINR)`, which rises with it, is less than `least`.
// Found by bisection to 0.01 dB.
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
