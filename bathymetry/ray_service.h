// SPDX-License-Identifier: BSD-3-Clause
// Answers a batch of questions about the terrain: what the bathymetry service computes, without the bus.
//
// Model: a query is of one mode. closest_hit and occluded follow each ray; depth looks below each origin; the
// two profiles take one ray, whose horizontal direction and range give the line. depth_tiles looks below
// kTileSide x kTileSide points of the lattice that has one point in the world's origin: the first is that
// nearest to the ray's origin, the others lie north and east of it. A query is answered whole or refused
// whole, with the reason: never cut. Stateless: the same query always has the same answer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bathymetry/terrain/profile.h"
#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry {

// The largest batch that is advised: a message of this many rays is 57 kB.
inline constexpr std::size_t kUsualRays = 1024;
// More rays, points of tiles or samples of a profile are refused.
inline constexpr std::size_t kMaxRays = 4096;
// Points of a tile along each side.
inline constexpr std::size_t kTileSide = 8;

enum class QueryMode : std::uint8_t {
  kClosestHit,
  kOccluded,
  kDepth,
  kUniformProfile,
  kExactProfile,
  kDepthTiles
};

struct RayBatch {
  QueryMode mode = QueryMode::kClosestHit;
  std::string expected_terrain = {};  // version_text of the terrain relied upon; empty: any
  double sample_spacing_m = 0;        // uniform_profile, depth_tiles: above 0
  std::vector<Ray> rays = {};         // 1 to kMaxRays; exactly 1 for a profile
};

enum class Refusal : std::uint8_t { kNone, kTooMany, kOtherTerrain, kBadQuery };

struct RayAnswers {
  Refusal refusal = Refusal::kNone;
  std::string reason = {};               // empty unless refused
  std::vector<RayStatus> statuses = {};  // one a result, in order; empty when refused
  // One a ray (of a tile one a point, eastwards row by row): the range of a hit; for depths z of the bottom
  // (status hit); for a profile its length (status hit). 0 with any other status, but for tiles: outside and
  // without data the last known depth, for sound.
  std::vector<double> results_m = {};
  std::vector<ProfilePoint> samples = {};  // of a profile
};

// terrain_version: version_text(terrain.version()), made once by the caller.
[[nodiscard]] RayAnswers answer(const Terrain& terrain, const std::string& terrain_version,
                                const RayBatch& batch);

}  // namespace halocline::bathymetry
