// SPDX-License-Identifier: BSD-3-Clause
// Seabed of a run as a grid of depths: an overview for charts and sections.
#pragma once

#include <cstddef>
#include <vector>

#include "bus/messages/messages.h"

namespace halocline::clients {

// Grid of posts in the world frame (NED), stored row by row from the south-west corner.
struct TerrainOverview {
  double south_m = 0, west_m = 0;                  // position of the first post, from the scenario's origin
  double north_spacing_m = 1, east_spacing_m = 1;  // distance between posts, above 0
  std::size_t rows = 0, columns = 0;
  // Seabed z of each post, positive down from the datum; NaN: no terrain; rows * columns.
  std::vector<float> depth_m;

  static TerrainOverview from(const terrain_tile_t& tile);

  float post_m(std::size_t row, std::size_t column) const { return depth_m[row * columns + column]; }
  // Coordinates of the last row and the last column.
  double north_m() const { return south_m + north_spacing_m * static_cast<double>(rows - 1); }
  double east_m() const { return west_m + east_spacing_m * static_cast<double>(columns - 1); }

  // Returns z of the seabed, interpolated bilinearly between posts, m; NaN outside of the grid and next to
  // posts without terrain.
  double depth_at_m(double north_m, double east_m) const;
};

}  // namespace halocline::clients
