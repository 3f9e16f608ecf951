// SPDX-License-Identifier: BSD-3-Clause
// Seabed as a picture: depth in the colours of cmocean's "deep", shaded as if lit from the north-west.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runs/timeline/terrain_overview.h"

namespace halocline::clients {

// Part of the world frame, m.
struct MapExtent {
  double south_m = 0, west_m = 0, north_m = 1, east_m = 1;
};

// Picture of the seabed, and its depths.
struct SeabedRaster {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;     // row by row from the south-west; alpha 0: no terrain
  std::vector<float> depth_m;         // depth of each pixel; NaN: no terrain
  float least_m = 0, greatest_m = 0;  // least and greatest of depth_m; least > greatest: no terrain at all
};

// Returns the colour for `share` from 0 (shallow) to 1 (deep).
std::array<std::uint8_t, 3> deep_colour(double share);

// Draws the seabed. Between posts it is a bicubic surface (Catmull and Rom 1974), next to posts without
// terrain a bilinear one.
SeabedRaster seabed_raster(const TerrainOverview& terrain, const MapExtent& extent, std::size_t width,
                           std::size_t height);

}  // namespace halocline::clients
