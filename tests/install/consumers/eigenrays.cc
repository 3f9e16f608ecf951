// SPDX-License-Identifier: BSD-3-Clause
// Asks the acoustics library for the paths of sound between two points, in water of one sound speed and in
// water from a grid of netCDF, which a module reads: eigenrays GRID
#include <cmath>
#include <cstdio>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/profile_reader.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"

namespace ha = halocline::acoustics;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  ha::Environment water{.profile = ha::SoundSpeedProfile::isovelocity(1500, {10, 35})};
  const ha::RayOptions options{.frequency_hz = 11'520};
  const auto paths = [&] {
    const ha::RaySea sea{ha::ray_water(water, options.frequency_hz), ha::BottomProfile::flat(100),
                         ha::sediment("MediumSand").value(), ha::RaySurface{.wind_mps = 5}, options};
    return ha::eigenrays(sea, {.source_depth_m = 30, .receiver_depth_m = 50, .range_m = 2000}).paths;
  };
  const auto straight = paths();
  if (straight.empty() || std::abs(straight.front().delay_s - std::hypot(2000, 20) / 1500) > 1e-9) return 1;
  std::printf("isovelocity: %zu paths, the first after %.6f s\n", straight.size(), straight.front().delay_s);

  const auto column = ha::read_grid_profile({.temperature_path = argv[1], .longitude_rad = -0.5},
                                            ha::SoundSpeedModel::kMackenzie1981);
  water.profile = column.profile;
  std::printf("%s: %zu paths\n", column.description.c_str(), paths().size());
  return paths().empty() ? 1 : 0;
}
