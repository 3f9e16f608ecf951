// SPDX-License-Identifier: BSD-3-Clause
// The waters of tests/data/rays, and the comparison of eigenrays with reference rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "tests/support/csv.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {

// What an eigenray is compared by.
struct ExpectedEigenray {
  double delay_s, amplitude, phase_deg, launch_deg, arrival_deg;
  int surface, bottom;
};

inline const FluidBottom kReferenceBottom = fluid_bottom(1.9, 1650, 0.8);
inline const RaySurface kFlatSurface{SurfaceModel::kFlat, 0};
inline double no_absorption(double) { return 0; }

inline RaySea sea_of(std::vector<SpeedRow> knots, BottomProfile bottom,
                     const AbsorptionAtDepth& absorption = no_absorption) {
  return {RayWater(std::move(knots), absorption), std::move(bottom), kReferenceBottom, kFlatSurface,
          RayOptions{.diffuse_below_db = 0, .airy_folds = false}};
}

inline RaySea reference_sea(const std::string& name) {
  if (name == "C1_thermocline") return sea_of({{0, 1520}, {50, 1490}, {100, 1490}}, BottomProfile::flat(100));
  if (name == "D1_upslope_iso") return sea_of({{0, 1500}}, BottomProfile({{0, 100}, {5000, 40}}));
  if (name == "D2_seamount_tri") {
    return sea_of({{0, 1520}, {50, 1490}, {200, 1492}},
                  BottomProfile({{0, 200}, {1500, 200}, {2500, 80}, {3500, 200}}));
  }
  if (name == "B_pekeris_thorp") {
    return sea_of({{0, 1500}}, BottomProfile::flat(100), [](double) { return 6.121954 / 1.00019998; });
  }
  return sea_of({{0, 1500}}, BottomProfile::flat(100));
}

using LinkKey = std::tuple<double, double, double>;
inline std::map<LinkKey, std::vector<testing::CsvRow>> reference_links(const std::string& name) {
  std::map<LinkKey, std::vector<testing::CsvRow>> links;
  for (const testing::CsvRow& row : testing::read_reference_csv("rays/" + name + "_exact.csv")) {
    links[{row.number("src_depth_m"), row.number("rcv_depth_m"), row.number("rcv_range_m")}].push_back(row);
  }
  return links;
}

inline std::string describe(const Eigenray& path) {
  return std::to_string(path.delay_s) + " s, launched at " +
         std::to_string(to_degrees(path.launch_angle_rad)) + " deg, " + std::to_string(path.surface_bounces) +
         "+" + std::to_string(path.bottom_bounces) + " bounces, " +
         std::to_string(20 * std::log10(path.amplitude)) + " dB";
}

// Whether any path meets neither surface nor bottom.
inline bool has_direct_path(const Eigenrays& found) {
  return std::any_of(found.paths.begin(), found.paths.end(), [](const Eigenray& path) {
    return path.surface_bounces == 0 && path.bottom_bounces == 0;
  });
}

inline double degrees_between(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

// Index of the path nearest in launch angle among those of the same bounces and delay; -1 for none.
inline int find_path(const std::vector<Eigenray>& paths, const std::vector<bool>& used, double delay_s,
                     double launch_rad, int surface, int bottom, double delay_tolerance_s) {
  int best = -1;
  double nearest = to_radians(0.02);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Eigenray& path = paths[i];
    const double off = std::abs(path.launch_angle_rad - launch_rad);
    if (used[i] || path.surface_bounces != surface || path.bottom_bounces != bottom || off > nearest)
      continue;
    if (std::abs(path.delay_s - delay_s) > delay_tolerance_s) continue;
    best = static_cast<int>(i);
    nearest = off;
  }
  return best;
}

}  // namespace halocline::acoustics
