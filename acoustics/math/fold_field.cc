// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/fold_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/airy.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kMinTime = 1e-13;  // s: rounding error of a delay

}  // namespace

double fold_place(double time_s, double frequency_hz) {
  // x = (3/4 omega dt)^(2/3) (fold_field.h).
  return elementary::pow(0.75 * 2 * pi * frequency_hz * std::max(time_s, kMinTime), 2.0 / 3);
}

FoldShare fold_share(double x) {
  const auto [ai, bi, ai_slope, bi_slope] = airy(-x);
  // phi = -atan2(Bi, Ai) at -x. Far from the fold it is (2/3) x^(3/2) - pi / 4, which plain rays have too and
  // which is therefore subtracted. The factor is C M / (2 A) = sqrt(pi) x^(1/4) M.
  const double turned = -elementary::atan2(bi, ai) - (2.0 / 3 * x * std::sqrt(x) - pi / 4);
  return {std::sqrt(pi * std::sqrt(x)) * elementary::hypot(ai, bi), std::remainder(turned, 2 * pi)};
}

// L = (|d2u| / (2 omega^2 dp^2))^(1/3).
double Fold::length_m(double frequency_hz) const {
  const double omega_p = 2 * pi * frequency_hz * slowness_slope;
  return elementary::cbrt(std::abs(curvature) / (2 * omega_p * omega_p));
}

// |du| = sqrt(2 L |d2u|) / (4 pi Ai(-x)^2).
double Fold::tube_slope(double x, double frequency_hz) const {
  const double ai = airy(-x).ai;
  return std::sqrt(2 * length_m(frequency_hz) * std::abs(curvature)) / (4 * pi * ai * ai);
}

}  // namespace halocline::acoustics
