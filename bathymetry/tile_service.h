// SPDX-License-Identifier: BSD-3-Clause
// Depths of the seabed at the posts of a regular tile, from which charts are drawn; computed without the bus.
//
// Posts lie `spacing_m` apart in both directions, row by row from the south, each row from the west. A post
// has the depth of the terrain at its position (Terrain::depth_at), in single precision (0.25 mm at 4000 m).
// Between the posts of a coarse tile the terrain may vary arbitrarily. Posts outside of the terrain, or
// without data, are unknown. Stateless: the same query always has the same answer, complete or refused with
// the reason.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry {

// Limit of posts in a tile: a message of this many has 50 kB.
inline constexpr std::int64_t kMaxPosts = 10'000;
// Limit of posts in a row or column of the overview.
inline constexpr int kMaxOverviewPosts = 97;

struct TileQuery {
  double south_m = 0, west_m = 0;  // first row and first column, local NED
  double spacing_m = 0;
  std::int64_t rows = 0, columns = 0;
};

struct Tile {
  std::string refusal = {};  // not empty: refused, without posts
  TileQuery query = {};
  std::vector<float> z_m = {};          // z of the bottom, m; 0 where unknown
  std::vector<std::int8_t> known = {};  // one for each post: 1 or 0
};

// Answers a query. Refused are positions and spacings that are not finite or out of range, tiles of no posts
// or too many, and tiles that do not touch the terrain.
[[nodiscard]] Tile answer(const Terrain& terrain, const TileQuery& query);

// Returns the whole terrain at the spacing of its posts, or at the finest spacing with at most
// kMaxOverviewPosts in each direction.
Tile overview(const Terrain& terrain);

// Returns the spacing of the finest grid, m.
double finest_spacing_m(const Terrain& terrain);

}  // namespace halocline::bathymetry
