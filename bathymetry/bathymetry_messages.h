// SPDX-License-Identifier: BSD-3-Clause
// Conversion between messages (ray_query_t / ray_reply_t, terrain_query_t / terrain_tile_t) and the values
// that the service computes with.
//
// Queries are converted without checks: the service gives invalid rays their status and refuses an invalid
// mode, count or spacing.
#pragma once

#include <cstdint>
#include <string>

#include "bathymetry/ray_service.h"
#include "bathymetry/terrain/terrain.h"
#include "bathymetry/tile_service.h"
#include "bus/messages/messages.h"

namespace halocline::bathymetry {

// Client and request of a query, repeated in the reply.
struct QueryHeader {
  std::int64_t utime = 0;
  std::string client_name;
  std::int64_t request_id = 0;
};

QueryHeader header_of(const ray_query_t& message);

// Without rays when num_rays is 0 or less. A mode below 0 becomes one above the last, which the service
// refuses.
RayBatch from_message(const ray_query_t& message);

// `session` is that of the service's current start.
ray_reply_t to_message(const QueryHeader& header, const RayAnswers& answers,
                       const std::string& terrain_version, std::int64_t session);

QueryHeader header_of(const terrain_query_t& message);
TileQuery from_message(const terrain_query_t& message);
// The publisher sets session and sequence.
terrain_tile_t to_message(const QueryHeader& header, const Tile& tile, const Terrain& terrain,
                          const std::string& terrain_version);

}  // namespace halocline::bathymetry
