// SPDX-License-Identifier: BSD-3-Clause
// Series and argument reductions of core/elementary.h and acoustics/math/fast_functions.h; not for other
// files.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace halocline::elementary::detail {

// Rounding constant: adding it to a double below 2^51 and subtracting it again rounds to an integer, whose
// low bits are then the low bits of the sum.
constexpr double kRound = 0x1.8p52;

// Constants ln 2, log10 2 and pi / 2 as sums of parts. The leading parts have 32 or 33 bits, so their
// products with integers below 2^20 are exact.
constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kLog10Of2High = 0x1.34413508p-2, kLog10Of2Low = 0x1.f79fef311f12bp-34;
constexpr double kHalfPiHigh = 0x1.921fb544p+0, kHalfPiMiddle = 0x1.0b4611a6p-34,
                 kHalfPiLow = 0x1.3198a2e037073p-69;
constexpr double kLog2OfE = 0x1.71547652b82fep+0, kLog2Of10 = 0x1.a934f0979a371p+1;
constexpr double kLn10 = 0x1.26bb1bbb55516p+1, kLog10OfE = 0x1.bcb7b1526e50ep-2;

// Functions for arguments that the inline code does not handle: not finite, without a normal result, or
// (sine) beyond its reduction.
double exp_beyond(double x);
double expm1_beyond(double x);
double log1p_beyond(double x);
double exp10_beyond(double x);
double log_beyond(double x);
double log2_beyond(double x);
double log10_beyond(double x);
double sin_beyond(double x);
double cos_beyond(double x);

// Returns exp(r + low) - 1 for |r| <= ln 2 / 2, where low is the rounding error of r, by the series of exp to
// r^13.
inline double expm1_of_rest(double r, double low) {
  const double r2 = r * r, r4 = r2 * r2;
  const double a = 1.0 / 2 + r * (1.0 / 6), b = 1.0 / 24 + r * (1.0 / 120), c = 1.0 / 720 + r * (1.0 / 5040),
               d = 1.0 / 40320 + r * (1.0 / 362880), e = 1.0 / 3628800 + r * (1.0 / 39916800),
               f = 1.0 / 479001600 + r * (1.0 / 6227020800);
  return r + (low + r2 * ((a + r2 * b) + r4 * ((c + r2 * d) + r4 * (e + r2 * f))));
}

// Returns y 2^n, where n is the low bits of `rounded` as left by kRound; the result must be a normal number.
inline double times_power_of_two(double y, double rounded) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(y) +
                               (std::bit_cast<std::uint64_t>(rounded) << 52));
}

// Splits x = 2^n (1 + f), with 1 + f between sqrt(1/2) and sqrt(2).
struct Split {
  double n, f;
};
inline Split split(double x) {
  constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcd, kOne = 0x3ff0000000000000;
  // Converts by the mantissa, as vectors have no 64-bit integer conversion before AVX-512.
  constexpr double kWhole = 0x1p52;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t raised = (bits - kRootOfHalf + kOne) >> 52;  // n + 1023
  const double n = std::bit_cast<double>(raised | std::bit_cast<std::uint64_t>(kWhole)) - (kWhole + 1023);
  return {n, std::bit_cast<double>(bits - (raised << 52) + kOne) - 1};
}

// Splits 1 + x = 2^n (1 + f), x >= 0, with f rounded once: both 2^-n x and 2^-n - 1 are exact.
inline Split split_one_and(double x) {
  const double n = split(1 + x).n, scale = times_power_of_two(1, kRound - n);
  return {n, x * scale + (scale - 1)};
}

// Returns the difference between f and ln(1 + f), minus `carried`:
//
//   f - ln(1 + f) = f^2 / 2 - s (f^2 / 2 + R),    s = f / (2 + f),    R = 2 s^2 / 3 + 2 s^4 / 5 + ...
//
// Since ln(1 + f) is the sum of a large exact term and this small one, its error stays below one unit.
inline double shortfall_of_log(double f, double carried) {
  const double s = f / (2 + f), z = s * s, z2 = z * z, z4 = z2 * z2;
  const double low = (2.0 / 3 + z * (2.0 / 5)) + z2 * (2.0 / 7 + z * (2.0 / 9)),
               high = (2.0 / 11 + z * (2.0 / 13)) + z2 * (2.0 / 15 + z * (2.0 / 17));
  const double r = z * (low + z4 * (high + z4 * (2.0 / 19 + z * (2.0 / 21)))), half = 0.5 * f * f;
  return half - (s * (half + r) + carried);
}

// Argument reduction: x minus the nearest multiple of pi / 2, as a sum of two doubles. `quarter` is the
// number of the multiple, of which only the low bits matter.
struct Reduced {
  double high, low;
  std::uint64_t quarter;
};
inline bool is_reducible(double x) { return std::abs(x) < 0x1p20; }
inline Reduced reduced(double x) {
  const double rounded = x * (2 / 3.14159265358979323846) + kRound, n = rounded - kRound;
  const double a = x - n * kHalfPiHigh, b = n * kHalfPiMiddle;  // both exact
  const double difference = a - b, taken = difference - a;
  const double error = (a - (difference - taken)) - (b + taken);
  const double c = n * kHalfPiLow, high = difference - c;
  return {high, ((difference - high) - c) + error, std::bit_cast<std::uint64_t>(rounded)};
}

// Returns sin(x + low) and cos(x + low) for |x| <= pi / 4, by their series to x^17 and x^16.
inline double sin_of_rest(double x, double low) {
  const double z = x * x, z2 = z * z, z4 = z2 * z2;
  const double a = -1.0 / 6 + z * (1.0 / 120), b = -1.0 / 5040 + z * (1.0 / 362880),
               c = -1.0 / 39916800 + z * (1.0 / 6227020800),
               d = -1.0 / 1307674368000 + z * (1.0 / 355687428096000);
  return x + (x * z * ((a + z2 * b) + z4 * (c + z2 * d)) + low * (1 - 0.5 * z));
}
inline double cos_of_rest(double x, double low) {
  const double z = x * x, z2 = z * z, z4 = z2 * z2;
  const double a = 1.0 / 24 - z * (1.0 / 720), b = 1.0 / 40320 - z * (1.0 / 3628800),
               c = 1.0 / 479001600 - z * (1.0 / 87178291200), d = 1.0 / 20922789888000;
  const double half = 0.5 * z, most = 1 - half;
  return most + (((1 - most) - half) + (z2 * ((a + z2 * b) + z4 * (c + z2 * d)) - x * low));
}

}  // namespace halocline::elementary::detail
