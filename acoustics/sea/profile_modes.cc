// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/profile_modes.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "acoustics/sea/sound_speed.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr int kRows = 8;              // over the height
constexpr double kFadesOut = 1.25;    // depth, in heights, from which the modes are 0
constexpr double kSameDepthM = 0.01;  // rows closer than that are one

double change_mps(const ProfileModes& modes, double depth_m) {
  const double z = std::min(depth_m / modes.height_m, 1.0) * std::numbers::pi;
  const double full = modes.first_mps * elementary::cos(z) + modes.second_mps * elementary::cos(2 * z);
  const double beyond = (depth_m / modes.height_m - 1) / (kFadesOut - 1);
  return full * std::clamp(1 - beyond, 0.0, 1.0);
}

// Depths of the profile's rows and of those that the modes need, ascending.
std::vector<double> depths_of(const SoundSpeedProfile& profile, const ProfileModes& modes) {
  std::vector<double> depths = profile.row_depths_m();
  if (depths.empty()) depths = profile.cell_boundaries_m();
  for (int i = 0; i <= kRows; ++i) depths.push_back(modes.height_m * i / kRows);
  depths.push_back(modes.height_m * kFadesOut);
  std::sort(depths.begin(), depths.end());
  std::vector<double> apart;
  for (const double depth : depths) {
    const bool fits = depth <= kDeepestWater && (apart.empty() || depth - apart.back() > kSameDepthM);
    if (fits) apart.push_back(depth);
  }
  return apart;
}

}  // namespace

SoundSpeedProfile with_modes(const SoundSpeedProfile& profile, const ProfileModes& modes,
                             double latitude_rad) {
  if (modes.first_mps == 0 && modes.second_mps == 0) return profile;
  const std::vector<double> depths = depths_of(profile, modes);
  if (!profile.knows_water()) {
    std::vector<SpeedRow> rows;
    for (const double z : depths)
      rows.push_back({z, std::clamp(profile.sound_speed_mps(z) + change_mps(modes, z), 1000.0, 2000.0)});
    return SoundSpeedProfile::from_speeds(std::move(rows), profile.water(0));
  }
  std::vector<WaterRow> rows;
  for (const double z : depths) {
    const WaterSample water = profile.water(z);
    const auto speed = [&](double temperature_degc) {
      return sound_speed_mps(profile.model(), temperature_degc, water.salinity_psu, z, latitude_rad);
    };
    const double t = water.temperature_degc, slope = speed(t + 0.5) - speed(t - 0.5);  // m/s a degree
    rows.push_back({z, std::clamp(t + change_mps(modes, z) / slope, -5.0, 45.0), water.salinity_psu});
  }
  return SoundSpeedProfile::from_water(std::move(rows), profile.model(), latitude_rad);
}

}  // namespace halocline::acoustics
