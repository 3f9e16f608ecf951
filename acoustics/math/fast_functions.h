// SPDX-License-Identifier: BSD-3-Clause
// Exponential, logarithm, sine and cosine for inner loops. They are inline and free of branches, so that
// compilers vectorise the loops. The relative error of the exponential and the absolute errors of the others
// are below 1e-9. Results are the same to the last bit on every machine with IEEE 754 arithmetic.
#pragma once

#include <bit>
#include <cstdint>
#include <numbers>

#include "core/elementary_series.h"

namespace halocline::acoustics {

// exp(x), with x limited to -700..700: x = n ln 2 + r with |r| <= ln 2 / 2, and the series of exp(r).
inline double fast_exp(double x) {
  using elementary::detail::kRound;
  const double low = x < -700 ? -700 : x, held = low > 700 ? 700 : low;
  const double rounded = held * std::numbers::log2e + kRound, n = rounded - kRound;
  const double r = held - n * std::numbers::ln2, r2 = r * r, r4 = r2 * r2;
  const double series =
      (1 + r) + r2 * (1.0 / 2 + r * (1.0 / 6)) +
      r4 * ((1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040)) + r4 * (1.0 / 40320));
  return elementary::detail::times_power_of_two(series, rounded);
}

// ln(x) of a normal number x > 0: x = 2^n (1 + f), and the series in f / (2 + f).
inline double fast_log(double x) {
  const auto [n, f] = elementary::detail::split(x);
  const double s = f / (2 + f), s2 = s * s, s4 = s2 * s2;
  const double series =
      (1 + s2 * (1.0 / 3)) + s4 * ((1.0 / 5 + s2 * (1.0 / 7)) + s4 * (1.0 / 9 + s2 * (1.0 / 11)));
  return n * std::numbers::ln2 + 2 * s * series;
}

// exp(j x) for |x| < 1e6: x = n pi / 2 + r with |r| <= pi / 4, and the series in r.
struct FastTurn {
  double cosine, sine;
};
inline FastTurn fast_turn(double x) {
  using elementary::detail::kRound;
  const double rounded = x * (2 / std::numbers::pi) + kRound, n = rounded - kRound;
  const double r = x - n * (std::numbers::pi / 2), z = r * r, z2 = z * z, z4 = z2 * z2;
  const double s = r + r * z *
                           ((-1.0 / 6 + z * (1.0 / 120)) + z2 * (-1.0 / 5040 + z * (1.0 / 362880)) -
                            z4 * (1.0 / 39916800)),
               c = 1 - z / 2 +
                   z2 * ((1.0 / 24 - z * (1.0 / 720)) + z2 * (1.0 / 40320 - z * (1.0 / 3628800)) +
                         z4 * (1.0 / 479001600));
  const auto quarter = std::bit_cast<std::uint64_t>(rounded);
  const double sine = (quarter & 1) != 0 ? c : s, cosine = (quarter & 1) != 0 ? s : c;
  return {((quarter + 1) & 2) != 0 ? -cosine : cosine, (quarter & 2) != 0 ? -sine : sine};
}

// The level in dB of a ratio above 0, and the ratio of a level in dB.
inline double fast_decibels(double ratio) { return 10 / std::numbers::ln10 * fast_log(ratio); }
inline double fast_power(double level_db) { return fast_exp(std::numbers::ln10 / 10 * level_db); }

// The remainder of x after whole periods, with the sign of x; |x / period| below 2^63.
inline double turned(double x, double period) {
  return x - period * static_cast<double>(static_cast<std::int64_t>(x / period));
}

}  // namespace halocline::acoustics
