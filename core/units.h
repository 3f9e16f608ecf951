// SPDX-License-Identifier: BSD-3-Clause
// Decibels, and the units that are used only in configuration, tables and output.
//
// All internal quantities are in SI units and radians. Decibels have a type of their own, so that a level is
// never used as a ratio. The reference of a level is part of its variable's name or stated in a comment (dB
// re 1 uPa for received levels, dB re 1 uPa at 1 m for source levels, dB re 1 uPa^2/Hz for noise spectra).
#pragma once

#include <compare>
#include <numbers>

#include "core/elementary.h"

namespace halocline {

// Logarithmic quantity: 10 log10 of a power ratio.
struct Decibels {
  double value = 0;

  constexpr auto operator<=>(const Decibels&) const = default;
  constexpr Decibels operator-() const { return {-value}; }
  constexpr Decibels operator+(Decibels other) const { return {value + other.value}; }
  constexpr Decibels operator-(Decibels other) const { return {value - other.value}; }
};

// Ratio of powers (or a power relative to the reference that its name states). Never negative.
struct PowerRatio {
  double value = 0;
  constexpr auto operator<=>(const PowerRatio&) const = default;
  constexpr PowerRatio operator+(PowerRatio other) const { return {value + other.value}; }
};

inline PowerRatio to_power_ratio(Decibels level) { return {elementary::exp10(level.value / 10.0)}; }
// Returns 10 log10(ratio); -infinity for a ratio of 0.
inline Decibels to_decibels(PowerRatio ratio) { return {10.0 * elementary::log10(ratio.value)}; }

constexpr double to_radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }
constexpr double to_degrees(double radians) { return radians * (180.0 / std::numbers::pi); }
constexpr double hz_to_khz(double hz) { return hz / 1000.0; }
constexpr double khz_to_hz(double khz) { return khz * 1000.0; }

}  // namespace halocline
