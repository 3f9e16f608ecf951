// SPDX-License-Identifier: BSD-3-Clause
// Distribution of a fading power by its first three cumulants: a constant plus a gamma variable.
//
// The normal score of a probability is the quantile of the standard normal distribution for it. The
// distribution here is exact for one scattered path (exponential) and for equal ones (gamma); for a steady
// path with a scattered one (Rice) it is within 0.5 dB from the 1 % quantile upwards; where the gamma
// variable falls below the low quantiles of Rice's distribution of the same variance, down to negative power,
// those hold. A negative third cumulant mirrors the distribution: interference that fades more than the
// signal. Quantiles are tabulated once over the normal score, -4.5..4.5, and the skewness, 0.1..2, with an
// error below 0.05 dB.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace halocline::acoustics {

// Mean, variance and third central moment of a power.
struct GammaPower {
  double mean = 0, variance = 0, third = 0;

  // Quantile at the normal score `z`: the power that is not exceeded with the probability of a standard
  // normal variable below `z`.
  double at(double z) const;
  // Quantiles at many scores.
  template <std::size_t count>
  std::array<double, count> at(const std::array<double, count>& scores) const {
    std::array<double, count> values = scores;
    replace(values);
    return values;
  }

 private:
  void replace(std::span<double> scores) const;  // replaces scores by quantiles in place
};

// Estimates the third cumulant of a sum of powers over the cube of its mean from `kept`, its variance over
// the square of its mean: (3 kept - 1) / 2 for two unequal parts (kept > 0.5), kept^2 for many equal ones.
double third_share(double kept);

}  // namespace halocline::acoustics
