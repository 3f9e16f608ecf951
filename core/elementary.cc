// SPDX-License-Identifier: BSD-3-Clause
#include "core/elementary.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <sleef.h>

namespace halocline::elementary {

namespace detail {

double exp_beyond(double x) { return Sleef_cinz_expd1_u10purec(x); }
double exp10_beyond(double x) { return Sleef_cinz_exp10d1_u10purec(x); }
double expm1_beyond(double x) { return Sleef_cinz_expm1d1_u10purec(x); }
double log1p_beyond(double x) { return Sleef_cinz_log1pd1_u10purec(x); }
double log_beyond(double x) { return Sleef_cinz_logd1_u10purec(x); }
double log2_beyond(double x) { return Sleef_cinz_log2d1_u10purec(x); }
double log10_beyond(double x) { return Sleef_cinz_log10d1_u10purec(x); }
double sin_beyond(double x) { return Sleef_cinz_sind1_u10purec(x); }
double cos_beyond(double x) { return Sleef_cinz_cosd1_u10purec(x); }

}  // namespace detail

namespace {

constexpr double kPi = 0x1.921fb54442d18p+1, kPiLow = 0x1.1a62633145c07p-53;  // their sum is pi to 106 bits

// Coefficients of (atan(u) / u - 1) / u^2 in powers of u^2, |u| <= tan(pi / 8), to 2e-19 (Chebyshev).
constexpr std::array<double, 12> kArcTangent{
    -0x1.5555555555555p-2, 0x1.9999999999953p-3, -0x1.249249248d7eep-3, 0x1.c71c71c304b68p-4,
    -0x1.745d165df3f95p-4, 0x1.3b1392d9e785cp-4, -0x1.110e880a7a521p-4, 0x1.e19a13b9fc6dfp-5,
    -0x1.ac7a938b69c93p-5, 0x1.74ddd408bb4c1p-5, -0x1.1b33b923aa954p-5, 0x1.0ad36a455cafbp-6};

// Coefficients of (1 + 2 x) exp(x^2) erfc(x) in powers of (x - 4) / (x + 4), x >= 0, to 2e-18 (Chebyshev; the
// form is that of Shepherd and Laframboise 1981).
constexpr std::array<double, 26> kScaledComplement{
    0x1.3ba5916e9fd7fp+0,   -0x1.1df1ad154a28ep-3,  0x1.f7f5df66fd6bap-7,   0x1.16ecefcfa5383p-4,
    -0x1.9ddb23c3e89f3p-4,  0x1.7fee004e1295bp-4,   -0x1.0fb06dfe52605p-4,  0x1.3079edf67777bp-5,
    -0x1.096238838fb04p-6,  0x1.49c6728a1a0f0p-8,   -0x1.8d4a9b0690e08p-11, -0x1.a1df289a58f28p-13,
    0x1.3be04c486a75ep-13,  -0x1.9958e21c32f5cp-16, -0x1.78862b6b1e3abp-17, 0x1.7f2545048fbf3p-18,
    0x1.398374178fe8cp-22,  -0x1.baf5e74545cc2p-21, 0x1.4cb0ece36623dp-24,  0x1.d98825ca9deb5p-24,
    -0x1.611fc8f45b510p-26, -0x1.fcc3a5268653fp-27, 0x1.b34e17ed4ff9fp-29,  0x1.f5d7df6dfda90p-30,
    -0x1.24000f0a15ee9p-32, -0x1.3ab58f87cfb03p-33};

template <std::size_t count>
double polynomial(const std::array<double, count>& coefficients, double x) {
  static_assert(count % 2 == 0);
  const double x2 = x * x;
  double sum = 0;
  for (std::size_t i = count; i > 0; i -= 2) sum = sum * x2 + (coefficients[i - 2] + x * coefficients[i - 1]);
  return sum;
}

// Returns erfc(x), 0 <= x < 26. For exp(-x^2), x^2 is split into the exact square of x's leading bits and a
// small rest:
//
//   erfc(x) = exp(-lead^2) exp(-rest) P((x - 4) / (x + 4)) / (1 + 2 x),    rest = x^2 - lead^2.
double erfc_above(double x) {
  const double lead = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & 0xfffffffff8000000);
  const double rest = (x - lead) * (x + lead);
  const double gauss = exp(-lead * lead) * (1 - rest * (1 - rest / 2 * (1 - rest / 3)));
  return gauss * polynomial(kScaledComplement, (x - 4) / (x + 4)) / (1 + 2 * x);
}

// Returns atan(y / x), 0 <= y <= x, x > 0. Above tan(pi / 8), with u = (y - x) / (y + x),
//
//   atan(y / x) = pi / 4 + atan(u).
double atan_of_ratio(double y, double x) {
  constexpr double kTangentOfEighth = 0.41421356237309503;
  const bool is_steep = y > kTangentOfEighth * x;
  const double u = is_steep ? (y - x) / (y + x) : y / x, z = u * u;
  const double bend = u * z * polynomial(kArcTangent, z);
  return is_steep ? kPi / 4 + (u + (bend + kPiLow / 4)) : u + bend;
}

}  // namespace

double pow(double x, double y) { return Sleef_cinz_powd1_u10purec(x, y); }
double tan(double x) { return Sleef_cinz_tand1_u10purec(x); }
double asin(double x) { return Sleef_cinz_asind1_u10purec(x); }
double acos(double x) { return Sleef_cinz_acosd1_u10purec(x); }
double cosh(double x) { return Sleef_cinz_coshd1_u10purec(x); }
double acosh(double x) { return Sleef_cinz_acoshd1_u10purec(x); }
double atanh(double x) { return Sleef_cinz_atanhd1_u10purec(x); }
// The first estimate exp(ln x / 3) has an error of some twenty units. It is improved by one Newton step,
//
//   root -= (root^3 - x) / (3 root^2).
double cbrt(double x) {
  const double size = std::abs(x);
  if (!(size > 1e-300 && size < 1e300)) return Sleef_cinz_cbrtd1_u10purec(x);
  const double root = exp(log(size) / 3), square = root * root;
  return std::copysign(root - (root * square - size) / (3 * square), x);
}
double erfc(double x) {
  if (!(std::abs(x) < 26)) return Sleef_cinz_erfcd1_u15purec(x);
  return x < 0 ? 2 - erfc_above(-x) : erfc_above(x);
}
double atan(double x) {
  const double size = std::abs(x);
  const double angle = size <= 1 ? atan_of_ratio(size, 1) : kPi / 2 - (atan_of_ratio(1, size) - kPiLow / 2);
  return std::isnan(x) ? x : std::copysign(angle, x);
}
double atan2(double y, double x) {
  const double high = std::abs(y), wide = std::abs(x);
  const bool is_plain = high > 1e-280 && wide > 1e-280 && high < 1e280 && wide < 1e280;
  if (!is_plain) return Sleef_cinz_atan2d1_u10purec(y, x);
  const double acute =
      high <= wide ? atan_of_ratio(high, wide) : kPi / 2 - (atan_of_ratio(wide, high) - kPiLow / 2);
  return std::copysign(x < 0 ? kPi - (acute - kPiLow) : acute, y);
}
double lgamma(double x) { return Sleef_cinz_lgammad1_u10purec(x); }

}  // namespace halocline::elementary
