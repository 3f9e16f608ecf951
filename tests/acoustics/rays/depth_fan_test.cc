// SPDX-License-Identifier: BSD-3-Clause
// Rays to receivers at several depths of one place, against searches of each by itself.
#include "acoustics/rays/depth_fan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

double power_of(const Eigenrays& found) {
  double power = 0;
  for (const Eigenray& path : found.paths) power += path.received_pressure() * path.received_pressure();
  return power;
}

double decibels(double power_ratio) { return 10 * std::log10(power_ratio); }

struct DepthFanCase {
  std::string name;
  std::vector<SpeedRow> water;
  BottomProfile bottom;
  double source_depth_m, range_m, deepest_m;
};

void PrintTo(const DepthFanCase& one, std::ostream* out) { *out << one.name; }

RaySea sea_of_depth_fan(const DepthFanCase& one) {
  RaySea sea = sea_of(one.water, one.bottom, [](double) { return 5.0; });
  sea.options = RayOptions{};
  return sea;
}

class DepthFanOver : public ::testing::TestWithParam<DepthFanCase> {};

// Depths as coverage takes them: the ends first, then the middles of what is between.
std::vector<double> depths_of_fan(double deepest_m) {
  std::vector<double> depths;
  for (int parts = 1; parts <= 32; parts *= 2) {
    for (int i = parts == 1 ? 0 : 1; i <= parts; i += parts == 1 ? 1 : 2)
      depths.push_back(2 + (deepest_m - 2) * i / parts);
  }
  return depths;
}

// The strong paths are those of the single search, within what depth_fan.h states; all together have the
// same power.
TEST_P(DepthFanOver, HasThePathsOfEachReceiverByItself) {
  const RaySea sea = sea_of_depth_fan(GetParam());
  DepthFan column;
  int strong = 0, missing = 0;
  for (const double depth_m : depths_of_fan(GetParam().deepest_m)) {
    const RayLink link{GetParam().source_depth_m, depth_m, GetParam().range_m};
    const Eigenrays alone = eigenrays(sea, link), together = eigenrays(sea, link, std::nullopt, &column);
    ASSERT_EQ(alone.silent(), together.silent()) << depth_m;
    if (alone.silent()) continue;
    EXPECT_NEAR(decibels(power_of(together) / power_of(alone)), 0, tolerance(0.05)) << depth_m;
    double strongest = 0;
    for (const Eigenray& path : alone.paths) strongest = std::max(strongest, path.received_pressure());
    for (const Eigenray& path : alone.paths) {
      if (path.received_pressure() < 0.1 * strongest) continue;
      const double weakness = strongest / path.received_pressure();
      const double slack = std::min(weakness * weakness, 100.0);  // of tolerances
      const bool is_there =
          std::any_of(together.paths.begin(), together.paths.end(), [&](const Eigenray& other) {
            return other.surface_bounces == path.surface_bounces &&
                   other.bottom_bounces == path.bottom_bounces &&
                   std::abs(other.delay_s - path.delay_s) < std::min(slack, 10.0) * tolerance(1e-6) &&
                   std::abs(20 * std::log10(other.received_pressure() / path.received_pressure())) <
                       slack * tolerance(0.05) &&
                   std::abs(other.launch_angle_rad - path.launch_angle_rad) < slack * tolerance(1e-4) &&
                   std::abs(other.arrival_angle_rad - path.arrival_angle_rad) < slack * tolerance(1e-3);
          });
      ++strong;
      if (!is_there) ++missing;
    }
  }
  EXPECT_GT(strong, 100);
  EXPECT_LE(missing, strong / 50);  // at folds two paths are one or two
}

INSTANTIATE_TEST_SUITE_P(
    Bottoms, DepthFanOver,
    ::testing::Values(DepthFanCase{"Hill3km", kSummer, cosine_hill(), 30, 3000, 135},
                      DepthFanCase{"Hill1km", kThermocline, cosine_hill(), 60, 1200, 190},
                      DepthFanCase{"Ducts5km", kDucts, cosine_hill(), 90, 4900, 195},
                      DepthFanCase{"Slope2km", kShelf, BottomProfile({{0, 120}, {5000, 60}}), 20, 2000, 90}),
    [](const auto& one) { return one.param.name; });

// Nothing is shared there.
TEST(DepthFanOverARoughBottom, IsTheSearchByItself) {
  const RaySea sea = sea_of_depth_fan({"", kRoughWater, rough_bottom(1, 1500), 40, 1500, 100});
  DepthFan column;
  for (const double depth_m : {30.0, 80.0, 55.0}) {
    const RayLink link{40, depth_m, 1500};
    const Eigenrays alone = eigenrays(sea, link), together = eigenrays(sea, link, std::nullopt, &column);
    ASSERT_EQ(alone.paths.size(), together.paths.size());
    for (std::size_t i = 0; i < alone.paths.size(); ++i) {
      EXPECT_EQ(alone.paths[i].delay_s, together.paths[i].delay_s);
      EXPECT_EQ(alone.paths[i].amplitude, together.paths[i].amplitude);
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
