// SPDX-License-Identifier: BSD-3-Clause
// Queries of the terrain and their answers, in world NED, m.
#pragma once

#include <cstddef>

#include "core/frames.h"

namespace halocline::channel_server {

// Kind of query; all rays of one message have the same.
enum class RayKind {
  kDepths,  // z of the seabed under each origin
  kWays,    // distance to the seabed along each ray, if it cuts it
  kTiles,   // z of the seabed at kTileSide x kTileSide points north and east of each origin; rows run east
};
inline constexpr int kTileSide = 8;
inline std::size_t answers_a_ray(RayKind kind) { return kind == RayKind::kTiles ? kTileSide * kTileSide : 1; }

// `direction` may have any length but 0.
struct TerrainRay {
  Vec3 origin_ned_m;
  Vec3 direction;
  double max_range_m;
};

struct RayAnswer {
  enum class Kind { kHit, kMiss, kOutside, kNoData, kBelowBottom, kBadInput };
  Kind kind = Kind::kMiss;
  // For a depth, z of the seabed; for a ray, the distance to the seabed. Set for kHit. For a point of a tile
  // with kOutside or kNoData, it is the last known depth.
  double result_m = 0;
};

// A depth belongs to a position, not to a ray: the range only has to be valid.
inline TerrainRay depth_ray(const Vec3& place_ned_m) { return {place_ned_m, Vec3::UnitZ(), 1}; }

}  // namespace halocline::channel_server
