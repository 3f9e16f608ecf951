// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/terrain_overview.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halocline::clients {

TerrainOverview TerrainOverview::from(const terrain_tile_t& tile) {
  TerrainOverview terrain;
  terrain.south_m = tile.tile_south_m;
  terrain.west_m = tile.tile_west_m;
  terrain.north_spacing_m = terrain.east_spacing_m = tile.post_spacing_m;
  terrain.rows = static_cast<std::size_t>(tile.tile_rows);
  terrain.columns = static_cast<std::size_t>(tile.tile_columns);
  terrain.depth_m = tile.seabed_z_m;
  for (std::size_t i = 0; i < tile.post_known.size(); ++i) {
    if (tile.post_known[i] == 0) terrain.depth_m[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return terrain;
}

double TerrainOverview::depth_at_m(double north_m, double east_m) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double row = (north_m - south_m) / north_spacing_m, column = (east_m - west_m) / east_spacing_m;
  if (rows < 2 || columns < 2) return kNone;
  const auto last_row = static_cast<double>(rows - 1), last_column = static_cast<double>(columns - 1);
  if (!(row >= 0 && row <= last_row && column >= 0 && column <= last_column)) return kNone;
  const auto r = static_cast<std::size_t>(std::min(row, last_row - 1));
  const auto c = static_cast<std::size_t>(std::min(column, last_column - 1));
  const double u = row - static_cast<double>(r), v = column - static_cast<double>(c);
  const auto between = [](double a, double b, double share) {
    return share == 0 ? a : share == 1 ? b : a + share * (b - a);
  };
  const double south = between(post_m(r, c), post_m(r, c + 1), v);
  const double north = between(post_m(r + 1, c), post_m(r + 1, c + 1), v);
  return between(south, north, u);
}

}  // namespace halocline::clients
