// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/waveform/kaiser_window.h"

#include <cmath>

namespace halocline::acoustics {
namespace {

// Modified Bessel function, I0(x) = sum over k of ((x / 2)^k / k!)^2.
double bessel_i0(double x) {
  double term = 1, sum = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= x / (2 * k) * (x / (2 * k));
    sum += term;
  }
  return sum;
}

}  // namespace

double kaiser_window(double x, double beta) {
  const double inside = 1 - x * x;
  return inside < 0 ? 0 : bessel_i0(beta * std::sqrt(inside)) / bessel_i0(beta);
}

}  // namespace halocline::acoustics
