// SPDX-License-Identifier: BSD-3-Clause
// Terrains that several tests and the benchmark share.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "bathymetry/terrain/fractal_relief.h"
#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/terrain.h"
#include "core/huge_page_vector.h"

namespace halocline::bathymetry::testing {

inline constexpr float kNoData =
    std::numeric_limits<float>::quiet_NaN();  // the depth of a post that has none

// Rugged bottom about 300 m deep, posts 10 m apart, its south-west corner at the origin: slopes to 45 degrees
// and more, and relief down to single cells, so that rays meet every kind of cell.
inline HeightGrid rugged_grid(int posts, double spacing_m = 10) {
  HeightGrid grid =
      make_grid({.spacing_m = spacing_m, .posts_x = posts, .posts_y = posts}, FlatShape{.depth_m = 300});
  add_relief(
      {.rms_m = 60, .longest_wavelength_m = 2000, .shortest_wavelength_m = 20, .hurst = 0.8, .seed = 42},
      grid);
  return grid;
}

// 3 x 3 posts, 10 m apart, from (0, 0): rows towards north, columns towards east.
inline HeightGrid small_grid(HugePageVector<float> posts) {
  return HeightGrid({.spacing_m = 10, .posts_x = 3, .posts_y = 3}, std::move(posts));
}

}  // namespace halocline::bathymetry::testing
