// Waters of layers, and a hill, like those that links run in, for tests and benchmarks of rays.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/sound_speed_profile.h"

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

}  // namespace halocline::acoustics
