// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/generated_terrain.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;

TEST(GeneratedTerrain, FlatIsFlat) {
  const HeightGrid grid = make_grid({.posts_x = 5, .posts_y = 7}, FlatShape{.depth_m = 42});
  for (const float post : grid.posts()) EXPECT_EQ(post, 42);
}

TEST(GeneratedTerrain, SlopeFallsAwayTowardsItsAzimuth) {
  const Shape east{SlopeShape{.depth_m = 100, .slope = 0.1, .azimuth_rad = std::numbers::pi / 2}};
  EXPECT_NEAR(depth_of(east, 0, 200), 120, tolerance(1e-9));
  EXPECT_NEAR(depth_of(east, 500, 0), 100, tolerance(1e-9));
}

TEST(GeneratedTerrain, RidgeIsConstantAlongItsCrestAndGaussianAcross) {
  const double azimuth = 0.7;
  const Shape ridge{RidgeShape{.depth_m = 200,
                               .height_m = 150,
                               .half_width_m = 300,
                               .crest_x_m = 50,
                               .crest_y_m = -20,
                               .azimuth_rad = azimuth}};
  for (const double along : {-1000.0, 0.0, 777.0}) {
    const double x = 50 + along * std::cos(azimuth), y = -20 + along * std::sin(azimuth);
    EXPECT_NEAR(depth_of(ridge, x, y), 50, tolerance(1e-9));
    // One scale off the crest: exp(-1/2).
    EXPECT_NEAR(depth_of(ridge, x - 300 * std::sin(azimuth), y + 300 * std::cos(azimuth)),
                200 - 150 * std::exp(-0.5), tolerance(1e-9));
  }
}

TEST(GeneratedTerrain, SeamountIsRoundWithItsSummitAtTheGivenPlace) {
  const Shape mount{SeamountShape{
      .depth_m = 2000, .height_m = 1700, .radius_m = 2500, .summit_x_m = 100, .summit_y_m = 200}};
  EXPECT_NEAR(depth_of(mount, 100, 200), 300, tolerance(1e-9));
  for (double azimuth = 0; azimuth < 6; azimuth += 0.5) {
    EXPECT_NEAR(depth_of(mount, 100 + 2500 * std::cos(azimuth), 200 + 2500 * std::sin(azimuth)),
                2000 - 1700 * std::exp(-0.5), tolerance(1e-9));
  }
}

TEST(GeneratedTerrain, FirstIndexCountsNorth) {
  const HeightGrid grid =
      make_grid({.first_x_m = -10, .first_y_m = 30, .spacing_m = 5, .posts_x = 3, .posts_y = 4},
                [](double x, double y) { return 1000 + x + 100 * y; });
  EXPECT_EQ(grid.post(2, 1), 1000 + 0 + 100 * 35);
}

TEST(GeneratedTerrain, RefusesImpossibleShapes) {
  const GridGeometry geometry{};
  EXPECT_THROW(make_grid(geometry, FlatShape{.depth_m = 20'000}), InvalidArgument);
  EXPECT_THROW(make_grid(geometry, FlatShape{.depth_m = std::nan("")}), InvalidArgument);
  EXPECT_THROW(make_grid(geometry, RidgeShape{.half_width_m = 0}), InvalidArgument);
  EXPECT_THROW(make_grid(geometry, SeamountShape{.radius_m = -1}), InvalidArgument);
  EXPECT_THROW(make_grid(geometry, SlopeShape{.slope = 100}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry
