// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/preamble_detection.h"

#include <cmath>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

// Probability that noise alone exceeds the threshold 2 T, T = `mean`, for M = `pieces` (Kay 1998, section
// 7.6):
//   P(chi-square of 2 M degrees > 2 T) = e^-T sum_{n<M} T^n / n!
double noise_above(double mean, int pieces) {
  double sum = 0, term = elementary::exp(-mean);
  for (int n = 0; n < pieces; ++n) {
    sum += term;
    term *= mean / (n + 1);
  }
  return sum;
}

}  // namespace

double detection_threshold(int pieces, double false_alarm) {
  require_in_range(pieces, 1, 256, "pieces of a preamble", "");
  require_in_range(false_alarm, 1e-15, 0.5, "probability of a false alarm", "");
  double low = 1e-3, high = 1;
  while (noise_above(high, pieces) > false_alarm) high *= 2;
  // Bisection: 60 steps reach the precision of a double.
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (noise_above(middle, pieces) > false_alarm ? low : high) = middle;
  }
  return high;
}

double detection_probability(int pieces, double false_alarm, PowerRatio energy_over_noise_density) {
  const double h = energy_over_noise_density.value;
  require(h >= 0, "an energy over a noise density must not be negative or NaN");
  // The threshold is kept between calls: callers ask for many energies of one detector, and it costs far more
  // than the rest.
  thread_local int known_pieces = 0;
  thread_local double known_false_alarm = 0, threshold = 0;
  if (known_pieces != pieces || known_false_alarm != false_alarm) {
    threshold = detection_threshold(pieces, false_alarm);
    known_pieces = pieces;
    known_false_alarm = false_alarm;
  }
  // Marcum 1960, h the energy over the noise density and T half the threshold:
  //   P_detect = Q_M(sqrt(2 h), sqrt(2 T)) = 1 - sum_{n>=M} e^-T T^n / n! P(Poisson(h) <= n - M).
  // Terms more than 12 standard deviations above the mean are negligible (Chernoff: below 1e-20).
  const int last = static_cast<int>(threshold + 12 * std::sqrt(threshold) + 60) + pieces;
  double noise_term = elementary::exp(-threshold), missed = 0;
  for (int n = 1; n <= pieces; ++n) noise_term *= threshold / n;
  double signal_term = elementary::exp(-h), signal_at_most = signal_term;
  for (int n = pieces; n <= last; ++n) {
    missed += noise_term * signal_at_most;
    noise_term *= threshold / (n + 1);
    signal_term *= h / (n + 1 - pieces);
    if (signal_term > 0) signal_at_most += signal_term;  // avoids 0 times infinity
  }
  return 1 - missed;
}

}  // namespace halocline::acoustics
