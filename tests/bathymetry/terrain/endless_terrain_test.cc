// SPDX-License-Identifier: BSD-3-Clause
// Terrain from a formula beyond its grid, and what sound is given where terrain ends.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "bathymetry/terrain/fractal_relief.h"
#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/terrain.h"
#include "core/frames.h"
#include "core/random.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using ::halocline::testing::tolerance;
using testing::kNoData;

constexpr GridGeometry kGrid{-100, -100, 10, 21, 21};

Terrain endless(const Shape& shape, const GridGeometry& geometry = kGrid) {
  return Terrain(make_grid(geometry, shape), {},
                 [shape](double x_m, double y_m) { return depth_of(shape, x_m, y_m); });
}

TEST(EndlessTerrain, APlaneIsExactEverywhere) {
  const SlopeShape slope{.depth_m = 100, .slope = 0.05, .azimuth_rad = 0.7};
  const Terrain terrain = endless(slope);
  for (const auto& [x_m, y_m] : {std::pair(0.0, 0.0), {105.0, 3.0}, {-4321.5, 777.7}, {200.0, -15'000.0}}) {
    const DepthSample sample = terrain.depth_at(x_m, y_m);
    ASSERT_EQ(sample.status, DepthStatus::kOk) << x_m << " " << y_m;
    EXPECT_NEAR(sample.z_m, depth_of(slope, x_m, y_m), tolerance(1e-3));  // posts are floats
    EXPECT_NEAR(sample.slope_north, 0.05 * std::cos(0.7), tolerance(1e-4));
  }
}

// A slope of 0.05 meets land after 2 km, and goes on to 12 km of height and of depth.
TEST(EndlessTerrain, ASlopeIsLevelWhereItIsHigherThanAnyLandAndDeeperThanAnySea) {
  const Terrain terrain = endless(SlopeShape{.depth_m = 100, .slope = 0.05});
  EXPECT_LT(terrain.depth_at(-3000, 0).z_m, 0);
  EXPECT_EQ(terrain.depth_at(-1e6, 0).z_m, -12'000);
  EXPECT_EQ(terrain.depth_at(1e6, 0).z_m, 12'000);
}

// The same relief over a grid that is larger: what lies beyond one is what the other holds.
TEST(EndlessTerrain, GoesOnAsALargerGridWouldToTheLastBit) {
  const RidgeShape ridge{.depth_m = 100, .height_m = 60, .half_width_m = 80, .azimuth_rad = 0.4};
  const FractalRelief relief{.rms_m = 6, .longest_wavelength_m = 300, .shortest_wavelength_m = 5};
  HeightGrid small = make_grid(kGrid, ridge), large = make_grid({-500, -500, 10, 101, 101}, ridge);
  add_relief(relief, small);
  add_relief(relief, large);
  const Terrain beyond(std::move(small), {},
                       [=, formula = ReliefFormula(relief, 10)](double x_m, double y_m) {
                         return static_cast<float>(depth_of(Shape(ridge), x_m, y_m)) + formula(x_m, y_m);
                       });
  const Terrain whole(std::move(large));
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto drawn = [&](std::uint32_t what) {
      return uniform_at({.purpose = purpose_of("place"), .who = what, .which = i});
    };
    const double x_m = 900 * drawn(0) - 450, y_m = 900 * drawn(1) - 450;
    ASSERT_NEAR(beyond.depth_at(x_m, y_m).z_m, whole.depth_at(x_m, y_m).z_m, 1e-9) << x_m << " " << y_m;
    const Vec3 direction(drawn(2) - 0.5, drawn(3) - 0.5, 0.3 * drawn(4));
    const Ray ray{{x_m, y_m, 20}, direction, 400};
    const RayHit here = beyond.closest_hit(ray), there = whole.closest_hit(ray);
    if (there.status == RayStatus::kOutside) continue;
    ASSERT_EQ(here.status, there.status) << i;
    if (here.status == RayStatus::kHit) {
      ASSERT_NEAR(here.range_m, there.range_m, 1e-6) << i;
    }
    EXPECT_EQ(beyond.closest_hits(std::vector{ray}).front().range_m, here.range_m) << "one as many";
  }
}

TEST(EndlessTerrain, ARayIsFollowedOutOfTheGridIntoItAndPastIt) {
  const Terrain terrain = endless(FlatShape{.depth_m = 50});
  const double far_m = std::sqrt(4000.0 * 4000 + 50 * 50);
  EXPECT_NEAR(terrain.closest_hit({{0, 0, 0}, {4000, 0, 50}, 1e5}).range_m, far_m, 1e-6);
  EXPECT_NEAR(terrain.closest_hit({{-2000, 0, 0}, {4000, 0, 50}, 1e5}).range_m, far_m, 1e-6);
  EXPECT_EQ(terrain.closest_hit({{-2000, 0, 10}, {1, 0, 0}, 4000}).status, RayStatus::kMiss);
  EXPECT_EQ(terrain.closest_hit({{5000, 5000, 60}, {1, 0, 0}, 10}).status, RayStatus::kStartedBelowBottom);
  EXPECT_EQ(terrain.closest_hit({{5000, 5000, 20}, {0, 0, 1}, 0}).status, RayStatus::kMiss);
}

TEST(HeldDepth, IsThatOfTheEdgeBeyondAndThatOfTheNearestPostInAGap) {
  const Terrain whole(testing::small_grid({1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(whole.depth_at(30, 10).status, DepthStatus::kOutside) << "who asks for data is given none";
  EXPECT_EQ(whole.held_depth_at(30, 10)->z_m, 8);
  EXPECT_TRUE(whole.held_depth_at(30, 10)->is_held);
  EXPECT_EQ(whole.held_depth_at(-1e6, 1e6)->z_m, 3);
  EXPECT_FALSE(whole.held_depth_at(5, 5)->is_held);
  EXPECT_FALSE(whole.held_depth_at(std::nan(""), 0));
  const Terrain with_gap(testing::small_grid({1, 1, kNoData, 1, 1, kNoData, 4, 4, kNoData}));
  EXPECT_EQ(with_gap.held_depth_at(1, 19)->z_m, 1);
  EXPECT_EQ(with_gap.held_depth_at(19, 19)->z_m, 4);
  EXPECT_EQ(with_gap.held_depth_at(500, 500)->z_m, 4) << "beyond a corner without data";
}

TEST(HeldDepth, IsThatOfTheBaseWhereANestedGridHasAHole) {
  HeightGrid fine =
      make_grid({.first_x_m = -50, .first_y_m = -50, .spacing_m = 5, .posts_x = 21, .posts_y = 21},
                FlatShape{.depth_m = 60});
  fine.posts_for_editing()[fine.index(10, 10)] = kNoData;
  const Terrain terrain(make_grid(kGrid, FlatShape{.depth_m = 50}), {{.grid = std::move(fine)}});
  EXPECT_EQ(terrain.depth_at(1, 1).status, DepthStatus::kNoData);
  EXPECT_EQ(terrain.held_depth_at(1, 1)->z_m, 50);
  EXPECT_TRUE(terrain.held_depth_at(1, 1)->is_held);
}

}  // namespace
}  // namespace halocline::bathymetry
