// SPDX-License-Identifier: BSD-3-Clause
// Elementary functions whose results do not depend on the processor or its C library. The C library chooses
// other code for exp, log or sin if it finds FMA or AVX, and its last bits differ between versions. All code
// that influences results calls these functions; the layers test forbids those of <cmath>. Operations that
// IEEE 754 rounds correctly (sqrt, floor, fma, remainder) are the same everywhere.
//
// Domains, signs, infinities and NaN are those of <cmath>, except for the sign of sin(-0). Inline functions
// use no tables, so a loop over them can be vectorised. The other functions, and arguments beyond the inline
// ranges, use functions of SLEEF (Shibata and Petrogalli 2020) that need neither FMA nor vector instructions.
//
// Errors in units in the last place, over all arguments unless a range is given:
//   exponentials  exp 0.9, expm1 1.8, exp10 1.3, pow 1
//   logarithms    log and log1p 0.9, log2 1.7, log10 1.8
//   angles        sin and cos 1.1, atan 1.3, atan2 1.6, tan, asin, acos 1
//   others        cosh, acosh, atanh, cbrt 1; hypot 1.2 (sides from 1e-150 to 1e150); erfc 4.5;
//                 lgamma 1.5 (x >= 1)
#pragma once

#include <cmath>
#include <complex>
#include <limits>

#include "core/elementary_series.h"

namespace halocline::elementary {

// Functions without branches, for vectorised loops: exp for |x| < 708 (error 0.9), ln(1 + x) for 0 <= x <
// 1e300 (error 1.5).
inline double exp_within(double x) {
  const double rounded = x * detail::kLog2OfE + detail::kRound, n = rounded - detail::kRound;
  const double high = x - n * detail::kLn2High, low = n * detail::kLn2Low, r = high - low;
  return detail::times_power_of_two(1 + detail::expm1_of_rest(r, (high - r) - low), rounded);
}
inline double log1p_within(double x) {
  const auto [n, f] = detail::split_one_and(x);
  return n * detail::kLn2High - (detail::shortfall_of_log(f, n * detail::kLn2Low) - f);
}

inline double exp(double x) { return std::abs(x) < 708 ? exp_within(x) : detail::exp_beyond(x); }

// expm1 by exp(x) - 1 = 2^n (exp(r) - 1) + (2^n - 1), with x = n ln 2 + r.
inline double expm1(double x) {
  if (!(std::abs(x) < 708)) return detail::expm1_beyond(x);
  const double rounded = x * detail::kLog2OfE + detail::kRound, n = rounded - detail::kRound;
  const double high = x - n * detail::kLn2High, low = n * detail::kLn2Low, r = high - low;
  const double power = detail::times_power_of_two(1, rounded);
  return power * detail::expm1_of_rest(r, (high - r) - low) + (power - 1);
}

inline double exp10(double x) {
  if (!(std::abs(x) < 307)) return detail::exp10_beyond(x);
  const double rounded = x * detail::kLog2Of10 + detail::kRound, n = rounded - detail::kRound;
  const double high = x - n * detail::kLog10Of2High, low = n * detail::kLog10Of2Low, r = high - low;
  return detail::times_power_of_two(
      1 + detail::expm1_of_rest(r * detail::kLn10, ((high - r) - low) * detail::kLn10), rounded);
}

inline double log(double x) {
  if (!(x >= std::numeric_limits<double>::min() && x <= std::numeric_limits<double>::max()))
    return detail::log_beyond(x);
  const auto [n, f] = detail::split(x);
  return n * detail::kLn2High - (detail::shortfall_of_log(f, n * detail::kLn2Low) - f);
}

// Returns ln(1 + x). The sum 1 + x is rounded, and its relative rounding error is added to the logarithm.
inline double log1p(double x) {
  constexpr double kRootOfHalfLessOne = -0.2928, kRootOfTwoLessOne = 0.4142;
  if (x > kRootOfHalfLessOne && x < kRootOfTwoLessOne) return x - detail::shortfall_of_log(x, 0);
  if (!(x > -1 && x < 1e300)) return detail::log1p_beyond(x);
  const double sum = 1 + x, lost = x > 1 ? 1 - (sum - x) : x - (sum - 1);
  const auto [n, f] = detail::split(sum);
  return n * detail::kLn2High - (detail::shortfall_of_log(f, n * detail::kLn2Low + lost / sum) - f);
}

inline double log2(double x) {
  if (!(x >= std::numeric_limits<double>::min() && x <= std::numeric_limits<double>::max()))
    return detail::log2_beyond(x);
  const auto [n, f] = detail::split(x);
  return n + (f - detail::shortfall_of_log(f, 0)) * detail::kLog2OfE;
}

inline double log10(double x) {
  if (!(x >= std::numeric_limits<double>::min() && x <= std::numeric_limits<double>::max()))
    return detail::log10_beyond(x);
  const auto [n, f] = detail::split(x);
  return n * detail::kLog10Of2High +
         ((f - detail::shortfall_of_log(f, 0)) * detail::kLog10OfE + n * detail::kLog10Of2Low);
}

struct SineCosine {
  double sine, cosine;
};
inline SineCosine sin_cos(double x) {
  if (!detail::is_reducible(x)) return {detail::sin_beyond(x), detail::cos_beyond(x)};
  const auto [high, low, quarter] = detail::reduced(x);
  const double s = detail::sin_of_rest(high, low), c = detail::cos_of_rest(high, low);
  const double sine = (quarter & 1) != 0 ? c : s, cosine = (quarter & 1) != 0 ? s : c;
  return {(quarter & 2) != 0 ? -sine : sine, ((quarter + 1) & 2) != 0 ? -cosine : cosine};
}
inline double sin(double x) {
  if (!detail::is_reducible(x)) return detail::sin_beyond(x);
  const auto [high, low, quarter] = detail::reduced(x);
  const double sine = (quarter & 1) != 0 ? detail::cos_of_rest(high, low) : detail::sin_of_rest(high, low);
  return (quarter & 2) != 0 ? -sine : sine;
}
inline double cos(double x) {
  if (!detail::is_reducible(x)) return detail::cos_beyond(x);
  const auto [high, low, quarter] = detail::reduced(x);
  const double cosine = (quarter & 1) != 0 ? detail::sin_of_rest(high, low) : detail::cos_of_rest(high, low);
  return ((quarter + 1) & 2) != 0 ? -cosine : cosine;
}

inline double hypot(double x, double y) { return std::sqrt(x * x + y * y); }
inline double hypot(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

double pow(double x, double y);
// Returns x^n by repeated multiplication; the error is at most |n| units.
inline double pow(double x, int n) {
  double result = 1, power = x;
  for (unsigned left = n < 0 ? 0U - static_cast<unsigned>(n) : static_cast<unsigned>(n); left != 0;
       left >>= 1) {
    if ((left & 1) != 0) result *= power;
    power *= power;
  }
  return n < 0 ? 1 / result : result;
}
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double cosh(double x);
double acosh(double x);
double atanh(double x);
double cbrt(double x);
double erfc(double x);
double lgamma(double x);

inline double abs(const std::complex<double>& z) { return hypot(z.real(), z.imag()); }
inline double arg(const std::complex<double>& z) { return atan2(z.imag(), z.real()); }
inline std::complex<double> polar(double magnitude, double angle_rad) {
  const auto [sine, cosine] = sin_cos(angle_rad);
  return {magnitude * cosine, magnitude * sine};
}

}  // namespace halocline::elementary
