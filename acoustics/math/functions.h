// Small functions that several models share.
#pragma once

namespace halocline::acoustics {

inline double squared(double x) { return x * x; }

// sin(pi x) / (pi x); 1 at 0.
double sinc(double x);

// The standard normal distribution, and its inverse for `probability` within (0, 1).
double normal_probability(double x);
double normal_quantile(double probability);

}  // namespace halocline::acoustics
