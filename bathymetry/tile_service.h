// SPDX-License-Identifier: BSD-3-Clause
// The seabed at the posts of a regular tile: what a chart is drawn from. Computed here without the bus.
//
// Model: posts lie `spacing_m` apart both ways, row by row from the south, each from the west; a post is the
// depth of the terrain at its place (Terrain::depth_at), in single precision (0.25 mm at 4000 m). Between
// posts of a coarse tile the terrain may do what it likes. Posts outside of the terrain, or where it has no
// data, are not known. Stateless: the same query always has the same answer, whole or refused with the
// reason.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry {

// Of one tile: a message of this many is 50 kB.
inline constexpr std::int64_t kMaxPosts = 10'000;
// Of the overview, in a row or a column.
inline constexpr int kMaxOverviewPosts = 97;

struct TileQuery {
  double south_m = 0, west_m = 0;  // of the first row and the first column, local NED
  double spacing_m = 0;
  std::int64_t rows = 0, columns = 0;
};

struct Tile {
  std::string refusal = {};  // not empty: there are no posts
  TileQuery query = {};
  std::vector<float> z_m = {};          // of the bottom, m down; 0 where not known
  std::vector<std::int8_t> known = {};  // one a post: 1 or 0
};

// Refused are a place or a spacing that is no number, no post or too many, and a tile that does not touch the
// terrain.
[[nodiscard]] Tile answer(const Terrain& terrain, const TileQuery& query);

// The whole terrain, at the spacing of its posts or the finest that needs no more than kMaxOverviewPosts
// either way.
Tile overview(const Terrain& terrain);

// Of the finest grid, m.
double finest_spacing_m(const Terrain& terrain);

}  // namespace halocline::bathymetry
