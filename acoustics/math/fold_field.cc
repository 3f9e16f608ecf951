#include "acoustics/math/fold_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kLeastTime = 1e-13;  // s: rounding of a delay

struct Airy {
  double ai, bi;
};

// By the series of Maclaurin (Abramowitz and Stegun 1964, 10.4.2), to 1e-12 for |z| <= 4.
Airy airy(double z) {
  constexpr double kAi0 = 0.355028053887817239, kSlope0 = 0.258819403792806798;  // Ai(0), -Ai'(0)
  constexpr int kTerms = 18;
  const double cube = z * z * z;
  double f = 1, g = z, f_term = 1, g_term = z;
  for (int k = 0; k < kTerms; ++k) {
    f_term *= cube / ((3 * k + 2) * (3 * k + 3));
    g_term *= cube / ((3 * k + 3) * (3 * k + 4));
    f += f_term;
    g += g_term;
  }
  return {kAi0 * f - kSlope0 * g, std::numbers::sqrt3 * (kAi0 * f + kSlope0 * g)};
}

}  // namespace

double fold_place(double time_s, double frequency_hz) {
  return std::pow(0.75 * 2 * pi * frequency_hz * std::max(time_s, kLeastTime), 2.0 / 3);
}

FoldShare fold_share(double x) {
  const auto [ai, bi] = airy(-x);
  // Far from the fold phi = (2/3) x^(3/2) - pi / 4, which the rays have by themselves.
  const double turned = -std::atan2(bi, ai) - (2.0 / 3 * x * std::sqrt(x) - pi / 4);
  return {std::sqrt(pi * std::sqrt(x)) * std::hypot(ai, bi), std::remainder(turned, 2 * pi)};
}

double Fold::length_m(double frequency_hz) const {
  const double omega_p = 2 * pi * frequency_hz * slowness_slope;
  return std::cbrt(std::abs(curvature) / (2 * omega_p * omega_p));
}

double Fold::tube_slope(double x, double frequency_hz) const {
  const double ai = airy(-x).ai;
  return std::sqrt(2 * length_m(frequency_hz) * std::abs(curvature)) / (4 * pi * ai * ai);
}

}  // namespace halocline::acoustics
