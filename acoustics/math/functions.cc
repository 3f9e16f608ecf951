// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/functions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline::acoustics {

using std::numbers::pi;
using std::numbers::sqrt2;

double sinc(double x) { return std::abs(x) < 1e-9 ? 1 : elementary::sin(pi * x) / (pi * x); }

// Phi(x) = erfc(-x / sqrt(2)) / 2.
double normal_probability(double x) { return elementary::erfc(-x / sqrt2) / 2; }

// The approximation 26.2.23 of Abramowitz and Stegun 1964, to 4.5e-4, refined by Newton's method. The inverse
// of Boost is not used, because it calls functions of the C library, whose last bits differ between machines.
double normal_quantile(double probability) {
  if (probability > 0.5) return -normal_quantile(1 - probability);
  const double t = std::sqrt(-2 * elementary::log(probability));
  double z =
      (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  for (int step = 0; step < 3; ++step) {
    const double density = elementary::exp(-z * z / 2) / std::sqrt(2 * pi);
    z -= (normal_probability(z) - probability) / density;
  }
  return z;
}

// The series P(k, x) = x^k e^-x / Gamma(k + 1) (1 + x / (k + 1) + x^2 / ((k + 1) (k + 2)) + ...).
double gamma_probability(double k, double x) {
  double term = 1, sum = 1;
  for (double n = k + 1; term > 1e-17 * sum; ++n) sum += term *= x / n;
  return sum * elementary::exp(k * elementary::log(x) - x - elementary::lgamma(k + 1));
}

// Newton's method for ln x. It starts from the approximation of Wilson and Hilferty 1931 or, for small
// probabilities, from the first term of the series.
double gamma_quantile_at(double k, double z) {
  const double probability = normal_probability(z);
  const double root = 1 - 1 / (9 * k) + z / (3 * std::sqrt(k));
  const double first = elementary::exp((elementary::log(probability) + elementary::lgamma(k + 1)) / k);
  double x = std::max(k * root * root * root, first);
  for (int step = 0; step < 8; ++step) {
    const double density_of_log = elementary::exp(k * elementary::log(x) - x - elementary::lgamma(k));
    x *= elementary::exp((probability - gamma_probability(k, x)) / density_of_log);
  }
  return x;
}

}  // namespace halocline::acoustics
