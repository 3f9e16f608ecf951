// SPDX-License-Identifier: BSD-3-Clause
// Rays of one bearing to receivers at many ranges and depths, against searches of each by itself.
#include "acoustics/rays/range_fan.h"

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
#include "core/check.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

struct RangeFanCase {
  std::string name;
  std::vector<SpeedRow> water;
  BottomProfile bottom;
  double source_depth_m, deepest_m;
  double half_db, nine_of_ten_db;  // of differences: the median, the 5th and the 95th of a hundred
};

void PrintTo(const RangeFanCase& one, std::ostream* out) { *out << one.name; }

RaySea sea_of_case(const RangeFanCase& one) {
  RaySea sea = sea_of(one.water, one.bottom, [](double) { return 5.0; });
  sea.options = RayOptions{};
  return sea;
}

double level_db(const Eigenrays& found) {
  double power = 0;
  for (const Eigenray& path : found.paths) power += path.received_pressure() * path.received_pressure();
  return 10 * std::log10(power);
}

std::vector<double> ranges_along() {
  std::vector<double> ranges;
  for (double range_m = 110; range_m < 4900; range_m += 190) ranges.push_back(range_m);
  return ranges;
}

// Of `values`, the one that so much are below.
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

class RangeFanOver : public ::testing::TestWithParam<RangeFanCase> {};

TEST_P(RangeFanOver, HasLevelsAndStrongestPathsCloseToThoseOfSearches) {
  const RaySea sea = sea_of_case(GetParam());
  RangeFan bearing(ranges_along());
  std::vector<double> off_db, off_s;
  for (const double range_m : ranges_along()) {
    for (double depth_m = 3; depth_m < GetParam().deepest_m; depth_m += 11) {
      const RayLink link{GetParam().source_depth_m, depth_m, range_m};
      const Eigenrays alone = eigenrays(sea, link), together = eigenrays(sea, link, std::nullopt, &bearing);
      ASSERT_FALSE(alone.silent() || together.silent()) << range_m << " " << depth_m;
      off_db.push_back(level_db(together) - level_db(alone));
      const Eigenray& strongest = *std::max_element(
          alone.paths.begin(), alone.paths.end(),
          [](const auto& a, const auto& b) { return a.received_pressure() < b.received_pressure(); });
      double nearest_s = 1;
      for (const Eigenray& path : together.paths)
        nearest_s = std::min(nearest_s, std::abs(path.delay_s - strongest.delay_s));
      off_s.push_back(nearest_s);
    }
  }
  EXPECT_GT(off_db.size(), 150U);
  EXPECT_NEAR(quantile(off_db, 0.5), 0, tolerance(GetParam().half_db));
  EXPECT_NEAR(quantile(off_db, 0.05), 0, tolerance(GetParam().nine_of_ten_db));
  EXPECT_NEAR(quantile(off_db, 0.95), 0, tolerance(GetParam().nine_of_ten_db));
  EXPECT_LT(quantile(off_s, 0.5), tolerance(1e-5));
  EXPECT_LT(quantile(off_s, 0.9), tolerance(5e-4));
}

// Straight rays over a bottom of the least slope: the images' closed form.
TEST(RangeFan, InIsovelocityWaterHasThePathsOfImages) {
  const std::vector<SpeedRow> water{{0, 1500}, {200, 1500}};
  const RaySea level = sea_of_case({"", water, BottomProfile::flat(100), 0, 0, 0, 0});
  const RaySea sloping = sea_of_case({"", water, BottomProfile({{0, 100}, {6000, 100.0001}}), 0, 0, 0, 0});
  RangeFan bearing({500, 1500, 4000});
  for (const double range_m : {4000.0, 500.0, 1500.0}) {
    const RayLink link{40, 70, range_m};
    const Eigenrays images = eigenrays(level, link, RaySolver::kImages),
                    fan = eigenrays(sloping, link, std::nullopt, &bearing);
    ASSERT_GE(std::min(fan.paths.size(), images.paths.size()), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(fan.paths[i].delay_s, images.paths[i].delay_s, tolerance(1e-7)) << range_m << " " << i;
      EXPECT_NEAR(fan.paths[i].amplitude / images.paths[i].amplitude, 1, tolerance(1e-3));
      EXPECT_NEAR(fan.paths[i].launch_angle_rad, images.paths[i].launch_angle_rad, tolerance(1e-4));
      EXPECT_NEAR(fan.paths[i].arrival_angle_rad, images.paths[i].arrival_angle_rad, tolerance(1e-4));
    }
  }
}

TEST(RangeFan, ARangeThatItWasNotMadeForIsSearched) {
  const RaySea sea = sea_of_case({"", kSummer, cosine_hill(), 0, 0, 0, 0});
  RangeFan bearing({1000, 3000});
  const RayLink link{30, 50, 2000};
  const Eigenrays alone = eigenrays(sea, link), together = eigenrays(sea, link, std::nullopt, &bearing);
  ASSERT_EQ(alone.paths.size(), together.paths.size());
  EXPECT_EQ(alone.paths.front().delay_s, together.paths.front().delay_s);
  EXPECT_THROW(RangeFan({2000, 1000}), InvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(
    Bottoms, RangeFanOver,
    ::testing::Values(RangeFanCase{"SummerHill", kSummer, cosine_hill(), 30, 79, 0.05, 2},
                      RangeFanCase{"ThermoclineHill", kThermocline, cosine_hill(), 60, 79, 0.05, 2},
                      RangeFanCase{"DuctsHill", kDucts, cosine_hill(), 70, 79, 0.05, 2},
                      RangeFanCase{"RoughSea", kRoughWater, rough_bottom(1, 5000), 40, 120, 0.5, 5},
                      RangeFanCase{"ShelfSlope", kShelf, BottomProfile({{0, 120}, {5000, 60}}), 20, 59, 0.05,
                                   2}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace halocline::acoustics
