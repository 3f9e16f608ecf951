// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/fractal_relief.h"

#include <cmath>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;

HeightGrid relief_grid(const FractalRelief& relief, const GridGeometry& geometry) {
  HeightGrid grid = make_grid(geometry, FlatShape{.depth_m = 0});
  add_relief(relief, grid);
  return grid;
}

double root_mean_square(const HeightGrid& grid) {
  double sum = 0;
  for (const float post : grid.posts()) sum += double{post} * post;
  return std::sqrt(sum / static_cast<double>(grid.posts().size()));
}

TEST(FractalRelief, AnyWindowOfItIsTheSame) {
  const FractalRelief relief{.rms_m = 5, .longest_wavelength_m = 400, .shortest_wavelength_m = 20, .seed = 9};
  const HeightGrid whole = relief_grid(relief, {-500, -500, 10, 101, 101});
  const HeightGrid window = relief_grid(relief, {-100, 200, 10, 21, 31});
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 31; ++j) ASSERT_EQ(window.post(i, j), whole.post(i + 40, j + 70)) << i << " " << j;
  }
}

TEST(FractalRelief, OfAPointIsThatOfTheGrid) {
  const FractalRelief relief{.rms_m = 5, .longest_wavelength_m = 400, .shortest_wavelength_m = 20, .seed = 9};
  const HeightGrid grid = relief_grid(relief, {-70, -70, 10, 15, 15});
  EXPECT_EQ(grid.post(3, 4), static_cast<float>(ReliefFormula(relief, 10)(-40, -30)));
}

TEST(FractalRelief, AnotherSeedIsAnotherRelief) {
  FractalRelief relief{.seed = 1};
  const double first = ReliefFormula(relief, 0)(123, 456);
  relief.seed = 2;
  EXPECT_NE(first, ReliefFormula(relief, 0)(123, 456));
  relief.seed = 1;
  EXPECT_EQ(first, ReliefFormula(relief, 0)(123, 456));
}

TEST(FractalRelief, HasTheRequestedRms) {
  // 80 x 80 longest wavelengths: the sample variance of so many cells is within a few per cent.
  const FractalRelief relief{
      .rms_m = 7, .longest_wavelength_m = 50, .shortest_wavelength_m = 10, .hurst = 0.8, .seed = 4};
  EXPECT_NEAR(root_mean_square(relief_grid(relief, {0, 0, 5, 801, 801})), 7, tolerance(0.2));
}

TEST(FractalRelief, IsRougherForASmallerHurstExponent) {
  const auto roughness = [](double hurst) {
    const HeightGrid grid =
        relief_grid({.rms_m = 5, .longest_wavelength_m = 400, .shortest_wavelength_m = 10, .hurst = hurst},
                    {0, 0, 5, 401, 401});
    double sum = 0;
    for (int i = 0; i < 401; ++i) {
      for (int j = 0; j < 400; ++j) sum += std::abs(grid.post(i, j + 1) - grid.post(i, j));
    }
    return sum;
  };
  EXPECT_GT(roughness(0.3), 1.5 * roughness(0.9));
}

TEST(FractalRelief, LeavesNoDataAlone) {
  HeightGrid grid =
      make_grid({.posts_x = 3, .posts_y = 3}, [](double x, double) { return x == 0 ? std::nan("") : 10; });
  add_relief({.rms_m = 5, .longest_wavelength_m = 10, .shortest_wavelength_m = 2}, grid);
  EXPECT_TRUE(std::isnan(grid.post(0, 1)));
  EXPECT_FALSE(std::isnan(grid.post(1, 1)));
}

TEST(FractalRelief, LeavesOutOctavesThatThePostsCannotHold) {
  EXPECT_EQ(root_mean_square(relief_grid({.rms_m = 5, .longest_wavelength_m = 15, .shortest_wavelength_m = 1},
                                         {0, 0, 10, 11, 11})),
            0);
}

TEST(FractalRelief, RefusesImpossibleParameters) {
  HeightGrid grid = make_grid({}, FlatShape{});
  EXPECT_THROW(add_relief({.rms_m = -1}, grid), InvalidArgument);
  EXPECT_THROW(add_relief({.longest_wavelength_m = 10, .shortest_wavelength_m = 20}, grid), InvalidArgument);
  EXPECT_THROW(add_relief({.hurst = 1.5}, grid), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry
