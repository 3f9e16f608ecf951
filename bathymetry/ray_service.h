// SPDX-License-Identifier: BSD-3-Clause
// Answers a batch of queries about the terrain: the computation of the bathymetry service, without the bus.
//
// A query has one mode.
//
//   closest_hit, occluded  follow each ray to the seabed
//   depth                  depth below each origin
//   depth_tiles            depths below kTileSide x kTileSide points of a lattice
//
// The lattice of depth_tiles has one point in the world's origin. The first point of a tile is the one
// nearest to the ray's origin, the others lie north and east of it.
//
// A query is answered completely or refused completely, with the reason; it is never truncated. Stateless:
// the same query always has the same answer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry {

// Largest recommended batch: a message of this many rays has 57 kB.
inline constexpr std::size_t kUsualRays = 1024;
// Limit of rays or tile points; a query with more is refused.
inline constexpr std::size_t kMaxRays = 4096;
// Points along each side of a tile.
inline constexpr std::size_t kTileSide = 8;

enum class QueryMode : std::uint8_t { kClosestHit, kOccluded, kDepth, kDepthTiles };

struct RayBatch {
  QueryMode mode = QueryMode::kClosestHit;
  std::string expected_terrain = {};  // required version_text of the terrain; empty: any
  double sample_spacing_m = 0;        // depth_tiles: above 0
  std::vector<Ray> rays = {};         // 1 to kMaxRays
};

enum class Refusal : std::uint8_t { kNone, kTooMany, kOtherTerrain, kBadQuery };

struct RayAnswers {
  Refusal refusal = Refusal::kNone;
  std::string reason = {};               // empty unless refused
  std::vector<RayStatus> statuses = {};  // one for each result, in order; empty when refused
  // One for each ray (for a tile, one for each point, row by row, each from west to east): the range of a
  // hit; for depths, z of the bottom (status hit). 0 with any other status, except for tiles: points outside
  // and without data have the last known depth, for acoustics.
  std::vector<double> results_m = {};
};

// Answers a batch. `terrain_version` is version_text(terrain.version()), which the caller computes once.
[[nodiscard]] RayAnswers answer(const Terrain& terrain, const std::string& terrain_version,
                                const RayBatch& batch);

}  // namespace halocline::bathymetry
