// SPDX-License-Identifier: BSD-3-Clause
// Small mathematical functions that several models share.
#pragma once

namespace halocline::acoustics {

inline double squared(double x) { return x * x; }

// sin(pi x) / (pi x); 1 at x = 0.
double sinc(double x);

// The standard normal distribution function, and its inverse for `probability` in (0, 1).
double normal_probability(double x);
double normal_quantile(double probability);

// Gamma distribution of shape k > 0 and scale 1: its distribution function at x > 0, and the quantile of the
// probability that a standard normal variable is less than z, -5..5.
double gamma_probability(double k, double x);
double gamma_quantile_at(double k, double z);

}  // namespace halocline::acoustics
