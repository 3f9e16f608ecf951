// SPDX-License-Identifier: BSD-3-Clause
// Queries of the terrain and their answers: world NED, m.
#pragma once

#include <cstddef>

#include "core/frames.h"

namespace halocline::channel_server {

// The kind of all rays of one message.
enum class RayKind {
  kDepths,  // z of the seabed under each origin
  kWays,    // whether the seabed cuts each ray
  kTiles,   // z of the seabed at kTileSide x kTileSide points north and east of each origin, eastwards row by
            // row
};
inline constexpr int kTileSide = 8;
inline std::size_t answers_a_ray(RayKind kind) { return kind == RayKind::kTiles ? kTileSide * kTileSide : 1; }

// `direction` of any length but 0.
struct TerrainRay {
  Vec3 origin_ned_m;
  Vec3 direction;
  double max_range_m;
};

struct RayAnswer {
  enum class Kind { kHit, kMiss, kOutside, kNoData, kBelowBottom, kBadInput };
  Kind kind = Kind::kMiss;
  // z of the seabed for a depth, distance for a way; of kHit, and of a tile outside and without data: the
  // last known depth.
  double result_m = 0;
};

// A depth belongs to a place, not to a ray: its range only has to be legal.
inline TerrainRay depth_ray(const Vec3& place_ned_m) { return {place_ned_m, Vec3::UnitZ(), 1}; }

}  // namespace halocline::channel_server
