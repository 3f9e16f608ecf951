// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/shallowest_pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"

namespace halocline::bathymetry {
namespace {

// Found by examining every post of the block.
float shallowest_post(const HeightGrid& grid, int level, int bi, int bj) {
  const GridGeometry& g = grid.geometry();
  float least = HUGE_VALF;
  for (int i = bi << level; i <= std::min((bi + 1) << level, g.cells_x()); ++i) {
    for (int j = bj << level; j <= std::min((bj + 1) << level, g.cells_y()); ++j) {
      least = std::min(least, grid.post(i, j));
    }
  }
  return least;
}

TEST(ShallowestPyramid, HoldsTheShallowestPostOfEveryBlock) {
  // Sizes that are no power of two, and one cell only.
  for (const auto& [rows, columns] : {std::pair{38, 21}, {2, 2}, {2, 9}, {33, 33}, {5, 4}}) {
    HeightGrid grid =
        make_grid({.spacing_m = 10, .posts_x = rows, .posts_y = columns}, FlatShape{.depth_m = 100});
    add_relief({.rms_m = 9, .longest_wavelength_m = 60, .shortest_wavelength_m = 20}, grid);
    const ShallowestPyramid pyramid(grid);
    for (int level = 1; level <= pyramid.top_level(); ++level) {
      for (int bi = 0; bi << level < rows - 1; ++bi) {
        for (int bj = 0; bj << level < columns - 1; ++bj) {
          ASSERT_EQ(pyramid.shallowest(level, bi, bj), shallowest_post(grid, level, bi, bj))
              << rows << "x" << columns << " level " << level << " block " << bi << " " << bj;
        }
      }
    }
    EXPECT_EQ(pyramid.shallowest_of_all(), *std::min_element(grid.posts().begin(), grid.posts().end()));
  }
}

TEST(ShallowestPyramid, BlocksWithNoDataAreNeverLeaptOver) {
  HeightGrid grid = testing::rugged_grid(17);
  grid.posts_for_editing()[grid.index(8, 8)] = std::nanf("");
  const ShallowestPyramid pyramid(grid);
  EXPECT_EQ(pyramid.shallowest(1, 3, 3), -HUGE_VALF);  // its corner post
  EXPECT_EQ(pyramid.shallowest(1, 4, 4), -HUGE_VALF);
  EXPECT_EQ(pyramid.shallowest_of_all(), -HUGE_VALF);
  EXPECT_GT(pyramid.shallowest(1, 0, 0), 0);
}

}  // namespace
}  // namespace halocline::bathymetry
