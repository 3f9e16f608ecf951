// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/terrain_window.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "viewer/pages/request_fields.h"

namespace halocline::monitor {
namespace {

constexpr std::size_t kMaxPostsAtOnce = 10'000;  // most posts in one query

struct Collection {
  DepthGrid grid;
  std::size_t missing = 0;  // queries without a reply
  std::function<void(const DepthGrid*, const std::string&)> done;
};

void take(Collection& collection, std::size_t first_row, const terrain_tile_t* tile,
          const std::string& problem) {
  if (!collection.done) return;  // it has failed before
  DepthGrid& grid = collection.grid;
  const std::size_t begin = first_row * grid.columns;
  if (tile != nullptr && begin + tile->seabed_z_m.size() <= grid.depth_m.size()) {
    for (std::size_t i = 0; i < tile->seabed_z_m.size(); ++i) {
      if (tile->post_known[i] != 0) grid.depth_m[begin + i] = tile->seabed_z_m[i];
    }
    if (--collection.missing == 0) collection.done(&grid, "");
  } else {
    collection.done(nullptr, problem);
    collection.done = nullptr;
  }
}

}  // namespace

DepthGrid terrain_window_in(const nlohmann::json& request) {
  constexpr std::int64_t kMaxRows = 257;
  DepthGrid window{.south_m = number_in(request, "south_m", -1e7, 1e7),
                   .west_m = number_in(request, "west_m", -1e7, 1e7),
                   .spacing_m = number_in(request, "spacing_m", 0.1, 1e6),
                   .rows = static_cast<std::uint16_t>(integer_in(request, "rows", 2, kMaxRows)),
                   .columns = static_cast<std::uint16_t>(integer_in(request, "columns", 2, kMaxRows)),
                   .depth_m = {}};
  window.depth_m.assign(std::size_t{window.rows} * window.columns, std::numeric_limits<float>::quiet_NaN());
  return window;
}

void collect_terrain(QueryDesk& queries, const DepthGrid& window,
                     const std::function<void(const DepthGrid* grid, const std::string& problem)>& done) {
  const std::size_t rows_at_once = std::max<std::size_t>(kMaxPostsAtOnce / window.columns, 1);
  auto collection = std::make_shared<Collection>();
  *collection = {window, (window.rows + rows_at_once - 1) / rows_at_once, done};
  for (std::size_t row = 0; row < window.rows; row += rows_at_once) {
    terrain_query_t query{};
    query.corner_north_m = window.south_m + window.spacing_m * static_cast<double>(row);
    query.corner_east_m = window.west_m;
    query.post_spacing_m = window.spacing_m;
    query.requested_rows = static_cast<std::int32_t>(std::min(rows_at_once, window.rows - row));
    query.requested_columns = window.columns;
    queries.ask(std::move(query), [collection, row](const terrain_tile_t* tile, const std::string& problem) {
      take(*collection, row, tile, problem);
    });
  }
}

void collect_overview(QueryDesk& queries, const std::function<void(const terrain_tile_t& overview)>& done) {
  constexpr double kMaxIntervals = 96;
  terrain_query_t any{};  // any query, for the extent in its reply
  any.post_spacing_m = 1;
  any.requested_rows = any.requested_columns = 1;
  queries.ask(std::move(any), [&queries, done](const terrain_tile_t* tile, const std::string&) {
    if (tile == nullptr) return;
    const double north_m = tile->extent_north_m - tile->extent_south_m,
                 east_m = tile->extent_east_m - tile->extent_west_m;
    if (north_m <= 0 || east_m <= 0) return;
    terrain_query_t whole{};
    whole.corner_north_m = tile->extent_south_m;
    whole.corner_east_m = tile->extent_west_m;
    whole.post_spacing_m = std::max(std::max(north_m, east_m) / kMaxIntervals, tile->finest_spacing_m);
    whole.requested_rows = static_cast<std::int32_t>(north_m / whole.post_spacing_m) + 1;
    whole.requested_columns = static_cast<std::int32_t>(east_m / whole.post_spacing_m) + 1;
    queries.ask(std::move(whole), [done](const terrain_tile_t* overview, const std::string&) {
      if (overview != nullptr) done(*overview);
    });
  });
}

}  // namespace halocline::monitor
