// Exponential and logarithm for inner loops, inline and without branches, so that compilers make loops of them vectors: relative error of the one and absolute error of the
// other below 1e-9. The same bits on every machine with IEEE 754 arithmetic.
#pragma once

#include <bit>
#include <cstdint>
#include <numbers>

namespace halocline::acoustics {

// exp(x), x held within -700..700: x = n ln 2 + r, |r| <= ln 2 / 2, by the series of r.
inline double fast_exp(double x) {
  constexpr double kRound = 0x1.8p52;  // its last bit is 1
  const double low = x < -700 ? -700 : x, held = low > 700 ? 700 : low;
  const double rounded = held * std::numbers::log2e + kRound, n = rounded - kRound;
  const double r = held - n * std::numbers::ln2, r2 = r * r, r4 = r2 * r2;
  const double series =
      (1 + r) + r2 * (1.0 / 2 + r * (1.0 / 6)) +
      r4 * ((1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040)) + r4 * (1.0 / 40320));
  const auto exponent = std::bit_cast<std::uint64_t>(rounded) + 1023;
  return series * std::bit_cast<double>(exponent << 52);
}

// ln(x), x a normal number above 0: x = 2^n m, m within sqrt(1/2)..sqrt(2), by the series of (m - 1) / (m + 1).
inline double fast_log(double x) {
  constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcd, kOne = 0x3ff0000000000000;
  constexpr double kWhole = 0x1p52;  // its mantissa counts
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t raised = (bits - kRootOfHalf + kOne) >> 52;  // n + 1023
  const double n = std::bit_cast<double>(raised | std::bit_cast<std::uint64_t>(kWhole)) - (kWhole + 1023);
  const double m = std::bit_cast<double>(bits - (raised << 52) + kOne);
  const double s = (m - 1) / (m + 1), s2 = s * s, s4 = s2 * s2;
  const double series =
      (1 + s2 * (1.0 / 3)) + s4 * ((1.0 / 5 + s2 * (1.0 / 7)) + s4 * (1.0 / 9 + s2 * (1.0 / 11)));
  return n * std::numbers::ln2 + 2 * s * series;
}

// A ratio above 0 in dB, and the ratio of a level in dB.
inline double fast_decibels(double ratio) { return 10 / std::numbers::ln10 * fast_log(ratio); }
inline double fast_power(double level_db) { return fast_exp(std::numbers::ln10 / 10 * level_db); }

// What is left of x after whole periods, with its sign; |x / period| below 2^63.
inline double turned(double x, double period) {
  return x - period * static_cast<double>(static_cast<std::int64_t>(x / period));
}

}  // namespace halocline::acoustics
