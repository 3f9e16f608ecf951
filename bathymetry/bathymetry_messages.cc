// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/bathymetry_messages.h"

#include <algorithm>
#include <vector>

#include "bathymetry/terrain/height_grid.h"
#include "core/frames.h"

namespace halocline::bathymetry {
namespace {

// The enumerations have the order of the message's constants.
static_assert(static_cast<int>(QueryMode::kClosestHit) == ray_query_t::CLOSEST_HIT);
static_assert(static_cast<int>(QueryMode::kOccluded) == ray_query_t::OCCLUDED);
static_assert(static_cast<int>(QueryMode::kDepth) == ray_query_t::DEPTH);
static_assert(static_cast<int>(QueryMode::kDepthTiles) == ray_query_t::DEPTH_TILES);
static_assert(static_cast<int>(RayStatus::kHit) == ray_reply_t::HIT);
static_assert(static_cast<int>(RayStatus::kMiss) == ray_reply_t::MISS);
static_assert(static_cast<int>(RayStatus::kOutside) == ray_reply_t::OUTSIDE);
static_assert(static_cast<int>(RayStatus::kNoData) == ray_reply_t::NO_DATA);
static_assert(static_cast<int>(RayStatus::kStartedBelowBottom) == ray_reply_t::BELOW_BOTTOM);
static_assert(static_cast<int>(RayStatus::kBadInput) == ray_reply_t::BAD_INPUT);
static_assert(static_cast<int>(Refusal::kNone) == ray_reply_t::OK);
static_assert(static_cast<int>(Refusal::kTooMany) == ray_reply_t::REFUSED_TOO_MANY);
static_assert(static_cast<int>(Refusal::kOtherTerrain) == ray_reply_t::REFUSED_OTHER_TERRAIN);
static_assert(static_cast<int>(Refusal::kBadQuery) == ray_reply_t::REFUSED_BAD_QUERY);

Vec3 as_vector(const std::vector<double>& list) { return {list[0], list[1], list[2]}; }

}  // namespace

QueryHeader header_of(const ray_query_t& message) {
  return {message.utime, message.client_name, message.request_id};
}

RayBatch from_message(const ray_query_t& message) {
  RayBatch batch;
  batch.mode = static_cast<QueryMode>(static_cast<std::uint8_t>(message.query_mode));
  batch.expected_terrain = message.expected_terrain;
  batch.sample_spacing_m = message.sample_spacing_m;
  const Vec3 base(message.base_origin_ned_m[0], message.base_origin_ned_m[1], message.base_origin_ned_m[2]);
  const auto count = static_cast<std::size_t>(std::max(message.num_rays, 0));
  batch.rays.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    batch.rays.push_back(
        {base + as_vector(message.offset_m[n]), as_vector(message.direction[n]), message.max_range_m[n]});
  }
  return batch;
}

ray_reply_t to_message(const QueryHeader& header, const RayAnswers& answers,
                       const std::string& terrain_version, std::int64_t session) {
  ray_reply_t message;
  message.utime = header.utime;
  message.session = session;
  message.request_id = header.request_id;
  message.terrain_version = terrain_version;
  message.reply_status = static_cast<std::int8_t>(answers.refusal);
  message.refusal = answers.reason;
  message.num_rays = static_cast<std::int32_t>(answers.statuses.size());
  for (const RayStatus status : answers.statuses)
    message.ray_status.push_back(static_cast<std::int8_t>(status));
  message.result_m = answers.results_m;
  return message;
}

QueryHeader header_of(const terrain_query_t& message) {
  return {message.utime, message.client_name, message.request_id};
}

TileQuery from_message(const terrain_query_t& message) {
  return {message.corner_north_m, message.corner_east_m, message.post_spacing_m, message.requested_rows,
          message.requested_columns};
}

terrain_tile_t to_message(const QueryHeader& header, const Tile& tile, const Terrain& terrain,
                          const std::string& terrain_version) {
  terrain_tile_t message{};
  message.utime = header.utime;
  message.request_id = header.request_id;
  message.tile_status = tile.refusal.empty() ? terrain_tile_t::OK : terrain_tile_t::REFUSED;
  message.refusal = tile.refusal;
  message.terrain_version = terrain_version;
  const GridGeometry& extent = terrain.extent();
  message.extent_south_m = extent.first_x_m;
  message.extent_west_m = extent.first_y_m;
  message.extent_north_m = extent.last_x_m();
  message.extent_east_m = extent.last_y_m();
  message.finest_spacing_m = finest_spacing_m(terrain);
  message.tile_south_m = tile.query.south_m;
  message.tile_west_m = tile.query.west_m;
  message.post_spacing_m = tile.query.spacing_m;
  message.tile_rows = static_cast<std::int32_t>(tile.query.rows);
  message.tile_columns = static_cast<std::int32_t>(tile.query.columns);
  message.num_posts = static_cast<std::int32_t>(tile.z_m.size());
  message.seabed_z_m = tile.z_m;
  message.post_known = tile.known;
  return message;
}

}  // namespace halocline::bathymetry
