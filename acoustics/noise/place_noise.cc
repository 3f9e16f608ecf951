// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/noise/place_noise.h"

#include <algorithm>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kLowestKhz = 0.5;  // below it the level is that here

// The level `level_db` at `at_khz`, falling by 17 dB a decade (Knudsen).
Decibels falling(double level_db, double at_khz, double khz) {
  return {level_db - 17 * elementary::log10(std::max(khz, kLowestKhz) / at_khz)};
}

Decibels shrimp(double level_db, double khz) {
  constexpr double kFlatFromKhz = 2, kFlatToKhz = 24;
  if (khz < kFlatFromKhz) return {level_db + 20 * elementary::log10(khz / kFlatFromKhz)};
  if (khz > kFlatToKhz) return {level_db - 20 * elementary::log10(khz / kFlatToKhz)};
  return {level_db};
}

}  // namespace

std::string_view to_name(NoisePlace place) {
  constexpr std::array<std::string_view, kNoisePlaces.size()> kNames{
      "open", "shelf", "wind-farm", "estuary", "harbour", "reef", "reef-edge", "fast-ice"};
  return kNames.at(static_cast<std::size_t>(place));
}

std::optional<Decibels> place_noise(NoisePlace place, double frequency_hz) {
  const double khz = hz_to_khz(frequency_hz);
  switch (place) {
    case NoisePlace::kShelf:
      return falling(42, 20, khz);
    case NoisePlace::kWindFarm:
      return falling(48, 20, khz);
    case NoisePlace::kEstuary:
      return falling(50, 20, khz);
    case NoisePlace::kHarbour:
      return falling(52, 20, khz);
    case NoisePlace::kReef:
      return shrimp(64, khz);
    case NoisePlace::kReefEdge:
      return shrimp(54, khz);
    case NoisePlace::kFastIce:
      return falling(45, 3.5, khz);
    case NoisePlace::kOpen:
      break;
  }
  return std::nullopt;
}

}  // namespace halocline::acoustics
