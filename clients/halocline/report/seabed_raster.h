// SPDX-License-Identifier: BSD-3-Clause
// The seabed as a picture: depth in cmocean's "deep" colours, shaded as if lit from the north-west.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "clients/mission/mission_terrain.h"

namespace halocline::clients {

// A part of the world frame, metres.
struct MapExtent {
  double south_m = 0, west_m = 0, north_m = 1, east_m = 1;
};

struct SeabedRaster {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;     // row by row from the south-west; alpha 0 where there is no terrain
  std::vector<float> depth_m;         // of the same pixels; NaN where there is none
  float least_m = 0, greatest_m = 0;  // of these; least > greatest when there is none
};

// `share` from 0, shallow, to 1, deep.
std::array<std::uint8_t, 3> deep_colour(double share);

// Between posts the seabed is a bicubic surface (Catmull and Rom 1974), beside posts without terrain a
// bilinear one.
SeabedRaster seabed_raster(const MissionTerrain& terrain, const MapExtent& extent, std::size_t width,
                           std::size_t height);

}  // namespace halocline::clients
