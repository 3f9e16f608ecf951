// Waters of layers like those that links run in, for tests of rays.
#pragma once

#include <vector>

#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {

// A summer thermocline above a duct, two ducts, the deep sea in 101 knots.
inline const std::vector<SpeedRow> kSummer = {{0, 1522},  {10, 1521.5}, {20, 1512},  {35, 1496},
                                              {50, 1490}, {70, 1492},   {100, 1488}, {120, 1491}};
inline const std::vector<SpeedRow> kDucts = {{0, 1500},  {30, 1503},  {50, 1492}, {60, 1490},
                                             {90, 1495}, {150, 1490}, {200, 1493}};
inline const std::vector<SpeedRow> kThermocline = {{0, 1520}, {50, 1490}, {100, 1490}};

inline std::vector<SpeedRow> munk_knots() {
  std::vector<SpeedRow> knots;
  for (int i = 0; i <= 100; ++i) knots.push_back({50.0 * i, munk_sound_speed_mps(50.0 * i)});
  return knots;
}

}  // namespace halocline::acoustics
