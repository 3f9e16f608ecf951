// SPDX-License-Identifier: BSD-3-Clause
// Waters of layers, and a hill, like those that links run in, for tests and benchmarks of rays.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/random.h"

namespace halocline::acoustics {

// A summer thermocline above a duct, the same without the duct, two ducts, the deep sea in 101 knots.
inline const std::vector<SpeedRow> kSummer = {{0, 1522},  {10, 1521.5}, {20, 1512},  {35, 1496},
                                              {50, 1490}, {70, 1492},   {100, 1488}, {120, 1491}};
inline const std::vector<SpeedRow> kShelf = {{0, 1522},  {10, 1521}, {20, 1512}, {35, 1500},
                                             {50, 1494}, {70, 1492}, {100, 1493}};
inline const std::vector<SpeedRow> kDucts = {{0, 1500},  {30, 1503},  {50, 1492}, {60, 1490},
                                             {90, 1495}, {150, 1490}, {200, 1493}};
inline const std::vector<SpeedRow> kThermocline = {{0, 1520}, {50, 1490}, {100, 1490}};

inline std::vector<SpeedRow> munk_knots() {
  std::vector<SpeedRow> knots;
  for (int i = 0; i <= 100; ++i) knots.push_back({50.0 * i, munk_sound_speed_mps(50.0 * i)});
  return knots;
}

// A cosine hill of 120 m under 200 m of water, in 100 facets of 50 m.
inline BottomProfile cosine_hill() {
  std::vector<ProfiledDepth> points;
  for (int i = 0; i <= 100; ++i) {
    const double along = (50.0 * i - 2500) / 1000;
    points.push_back(
        {50.0 * i, std::abs(along) < 1 ? 200 - 60 * (1 + std::cos(std::numbers::pi * along)) : 200});
  }
  return BottomProfile(std::move(points));
}

// A bottom 150 m deep with a relief of 5 m rms: waves of 1 km to 62 m that are halved in length, as high as
// their length to the power of 1.1, eight of each; sampled each 12.5 m.
inline BottomProfile rough_bottom(std::uint32_t seed, double to_m) {
  constexpr int kOctaves = 5, kWaves = 8;
  constexpr double kHurst = 1.1;
  double squares = 0;
  for (int octave = 0; octave < kOctaves; ++octave) squares += std::pow(0.5, 2 * kHurst * octave);
  std::vector<ProfiledDepth> points;
  for (int i = -3; i <= to_m / 12.5 + 3; ++i) {
    double depth = 150;
    for (int octave = 0; octave < kOctaves; ++octave) {
      const double height = 5 * std::sqrt(2.0 / kWaves / squares) * std::pow(0.5, kHurst * octave);
      for (int wave = 0; wave < kWaves; ++wave) {
        const auto draw = [&](std::uint64_t which) {
          const std::uint64_t index = 2 * static_cast<std::uint64_t>(kWaves * octave + wave) + which;
          return uniform_at({.seed = 7, .purpose = purpose_of("rough bottom"), .who = seed, .which = index});
        };
        const double length = 1000 * std::pow(0.5, octave + draw(0) - 0.5);
        depth += height * std::cos(2 * std::numbers::pi * (12.5 * i / length + draw(1)));
      }
    }
    points.push_back({12.5 * i, depth});
  }
  return BottomProfile(std::move(points));
}

inline const std::vector<SpeedRow> kRoughWater = {
    {0, 1520}, {20, 1518}, {50, 1495}, {100, 1491}, {200, 1492}};

}  // namespace halocline::acoustics
