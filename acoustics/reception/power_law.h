// SPDX-License-Identifier: BSD-3-Clause
// How a fading power is distributed: gamma distributed beside a constant, by its first three cumulants.
//
// Exact for one scattered path (exponential) and for equal ones (gamma); of a steady path with a scattered
// one (Rice) within 0.5 dB from the 1 % quantile up. A negative third cumulant mirrors it: interference that
// fades more than the signal. Quantiles are tabulated once, over the normal score of the probability,
// -4.5..4.5, and the skewness, 0.1..2; the error is below 0.05 dB.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace halocline::acoustics {

struct PowerLaw {
  double mean = 0, variance = 0, third = 0;

  // The value that is fallen below with the probability that a standard normal falls below `z`.
  double at(double z) const;
  // At many scores.
  template <std::size_t count>
  std::array<double, count> at(const std::array<double, count>& scores) const {
    std::array<double, count> values = scores;
    replace(values);
    return values;
  }

 private:
  void replace(std::span<double> scores) const;  // by the values there
};

// Of a gamma variable of mean 1 whose skewness is `skewness`, 0.1..2: variance = skewness^2 / 4.
double gamma_quantile(double z, double skewness);

// Of the third cumulant of a sum of powers over the cube of its mean, for its variance over the square: of
// two unequal parts, or of many equal ones.
double third_share(double kept);

}  // namespace halocline::acoustics
