// SPDX-License-Identifier: BSD-3-Clause
// Small functions that several models share.
#pragma once

namespace halocline::acoustics {

inline double squared(double x) { return x * x; }

// sin(pi x) / (pi x); 1 at 0.
double sinc(double x);

// The standard normal distribution, and its inverse for `probability` within (0, 1).
double normal_probability(double x);
double normal_quantile(double probability);

// The gamma distribution of shape k > 0 and scale 1: the probability of less than x > 0; and the value that
// has the probability of a standard normal one of less than z, -5..5.
double gamma_probability(double k, double x);
double gamma_quantile_at(double k, double z);

}  // namespace halocline::acoustics
