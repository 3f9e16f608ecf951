// SPDX-License-Identifier: BSD-3-Clause
// Noise that a place adds to that of the open sea: boats, coasts, pumps, snapping shrimp, ice.
//
// Spectrum levels N(f), dB re 1 uPa^2/Hz, f in kHz:
//   shelf      42 - 17 log10(f / 20)    distant coast, ships and boats near 20 kHz
//   wind-farm  48 - 17 log10(f / 20)    turbines, service boats, scour
//   estuary    50 - 17 log10(f / 20)    flow, sediment, boats; also river mouths and tidal lagoons
//   harbour    52 - 17 log10(f / 20)    small craft, pumps, sonars
//   reef       64 from 2 to 24 kHz, 64 - 20 log10(f / 24) above, 64 + 20 log10(f / 2) below
//   reef-edge  10 dB less
//   fast-ice   45 - 17 log10(f / 3.5)   in the place of wind: cracks of ice that lies fast to the shore
// The open sea adds nothing. The slope of 17 dB a decade is Knudsen's; below 500 Hz the level is that at 500
// Hz, because the fits are for higher frequencies. Reefs: 25 dB above sea state 2 at 20 kHz over a bed of
// snapping shrimp, flat from 2 to 24 kHz, 10 dB less within a mile of it (Johnson, Everest and Young 1947,
// JASA 20, 137); present beyond 200 kHz (Cato and Bell 1992, MRL-TR-91-23). All other levels
// and both slopes of reefs are our choices. A place lies within some 6 dB of its kind's level
// (kPlaceSpreadDb). Left out: fish, whales, rain (acoustics/sea/noise.h), single ships (vehicle noise).
//
//   const double level_db = place_noise(NoisePlace::kHarbour, 25e3).value().value;  // 50.4
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/units.h"

namespace halocline::acoustics {

// Kinds of places.
enum class NoisePlace { kOpen, kShelf, kWindFarm, kEstuary, kHarbour, kReef, kReefEdge, kFastIce };

inline constexpr std::array kNoisePlaces = {
    NoisePlace::kOpen,    NoisePlace::kShelf, NoisePlace::kWindFarm, NoisePlace::kEstuary,
    NoisePlace::kHarbour, NoisePlace::kReef,  NoisePlace::kReefEdge, NoisePlace::kFastIce};

// Deviation of one place from the level of its kind, dB either way.
inline constexpr double kPlaceSpreadDb = 6;

// Names of the places: "open", "shelf", "wind-farm", "estuary", "harbour", "reef", "reef-edge", "fast-ice".
std::string_view to_name(NoisePlace place);

// Spectrum level that the place adds, dB re 1 uPa^2/Hz, at `frequency_hz` > 0; empty for the open sea.
std::optional<Decibels> place_noise(NoisePlace place, double frequency_hz);

// True when the wind makes no noise at the place.
constexpr bool is_under_ice(NoisePlace place) { return place == NoisePlace::kFastIce; }
// True when snaps or cracks make up the place's noise, so that it is far from Gaussian.
constexpr bool is_impulsive(NoisePlace place) {
  return place == NoisePlace::kReef || place == NoisePlace::kReefEdge || place == NoisePlace::kFastIce;
}
// Exponent of the alpha-stable noise of such places (Chitre, Potter and Ong 2006: 1.6 to 1.9 in warm shallow
// waters; the value is our choice).
inline constexpr double kPlaceBurstExponent = 1.7;
// Rise of the place's noise from noon to midnight, dB: 4 over and beside a reef (3 to 6, Johnson et al.
// 1947), 0 elsewhere.
constexpr double day_night_db(NoisePlace place) {
  return place == NoisePlace::kReef || place == NoisePlace::kReefEdge ? 4 : 0;
}

// The place of a scenario that names none: shelf in water of up to 500 m, else open.
constexpr NoisePlace place_of_depth(double depth_m) {
  constexpr double kShelfDepthM = 500;
  return depth_m > kShelfDepthM ? NoisePlace::kOpen : NoisePlace::kShelf;
}

}  // namespace halocline::acoustics
