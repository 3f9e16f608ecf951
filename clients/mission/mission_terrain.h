// SPDX-License-Identifier: BSD-3-Clause
// The seabed of a mission as a grid of depths: an overview for charts and sections.
#pragma once

#include <cstddef>
#include <vector>

#include "bus/messages.h"

namespace halocline::clients {

// Posts lie on a grid in the world frame, row by row from the south-west.
struct MissionTerrain {
  double south_m = 0, west_m = 0;                  // of the first post, from the scenario's origin
  double north_spacing_m = 1, east_spacing_m = 1;  // between posts, above 0
  std::size_t rows = 0, columns = 0;
  std::vector<float> depth_m;  // z down from the datum; NaN where there is no terrain; rows * columns

  static MissionTerrain from(const terrain_tile_t& tile);

  float post_m(std::size_t row, std::size_t column) const { return depth_m[row * columns + column]; }
  double north_m() const {
    return south_m + north_spacing_m * static_cast<double>(rows - 1);
  }  // of the last row
  double east_m() const { return west_m + east_spacing_m * static_cast<double>(columns - 1); }

  // Linear between posts; NaN outside and beside posts without terrain.
  double depth_at_m(double north_m, double east_m) const;
};

}  // namespace halocline::clients
