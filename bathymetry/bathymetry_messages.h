// SPDX-License-Identifier: BSD-3-Clause
// Between ray_query_t / ray_reply_t, terrain_query_t / terrain_tile_t and the values the service computes
// with.
//
// A query is read as it stands: rays that are impossible get their status from the service, an impossible
// mode, count or spacing its refusal. Both directions exist for both types, for clients and for round-trip
// tests.
#pragma once

#include <cstdint>
#include <string>

#include "bathymetry/ray_service.h"
#include "bathymetry/terrain/terrain.h"
#include "bathymetry/tile_service.h"
#include "bus/messages.h"
#include "core/frames.h"

namespace halocline::bathymetry {

// Client and request of a query, repeated in the reply.
struct QueryHeader {
  std::int64_t utime = 0;
  std::string client_name;
  std::int64_t request_id = 0;
};

QueryHeader header_of(const ray_query_t& message);

// num_rays 0 or less: no rays. A mode below 0 becomes one above the last, which the service refuses.
RayBatch from_message(const ray_query_t& message);

// Rays relative to `base_ned_m`, so that far from the origin offsets stay short.
ray_query_t to_message(const QueryHeader& header, const RayBatch& batch, const Vec3& base_ned_m);

// session: of this start of the service.
ray_reply_t to_message(const QueryHeader& header, const RayAnswers& answers,
                       const std::string& terrain_version, std::int64_t session);

// A sample that is not valid on the bus comes back as no_data.
RayAnswers from_message(const ray_reply_t& message);

QueryHeader header_of(const terrain_query_t& message);
TileQuery from_message(const terrain_query_t& message);
// Session and sequence are the publisher's to fill in.
terrain_tile_t to_message(const QueryHeader& header, const Tile& tile, const Terrain& terrain,
                          const std::string& terrain_version);

}  // namespace halocline::bathymetry
