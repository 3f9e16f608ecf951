// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/tile_service.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bathymetry/terrain/height_grid.h"
#include "core/csv_table.h"

namespace halocline::bathymetry {
namespace {

constexpr double kMaxSpacingM = 1e6;
// Tolerance as a share of the spacing: positions that are off by rounding only lie on the terrain's edge.
constexpr double kRounding = 1e-6;

std::string problem(const std::string& field, double value, const std::string& allowed) {
  return field + " is " + format_number(value) + "; allowed is " + allowed;
}

std::string span(double from, double to) { return format_number(from) + " to " + format_number(to); }

// Checks one direction: a tile of `length` from `first` on must meet the terrain between `low` and `high`.
// Returns the problem, or an empty string.
std::string problem_of_corner(const std::string& field, double first, double length, double low,
                              double high) {
  const bool touches = first <= high && first + length >= low;  // false for NaN
  return touches ? ""
                 : problem(field, first, span(low - length, high) + ", where the tile meets the terrain");
}

std::string refusal_of(const GridGeometry& extent, const TileQuery& q) {
  if (!(q.spacing_m > 0 && q.spacing_m <= kMaxSpacingM))
    return problem("post_spacing_m", q.spacing_m, "above 0 to " + format_number(kMaxSpacingM));
  for (const auto& [field, count] : {std::pair("requested_rows", q.rows), {"requested_columns", q.columns}}) {
    if (count < 1 || count > kMaxPosts)
      return problem(field, static_cast<double>(count), "1 to " + std::to_string(kMaxPosts));
  }
  if (q.rows * q.columns > kMaxPosts) {
    return problem("requested_rows times requested_columns", static_cast<double>(q.rows * q.columns),
                   "1 to " + std::to_string(kMaxPosts));
  }
  const double height = static_cast<double>(q.rows - 1) * q.spacing_m,
               width = static_cast<double>(q.columns - 1) * q.spacing_m;
  const std::string north =
      problem_of_corner("corner_north_m", q.south_m, height, extent.first_x_m, extent.last_x_m());
  return north.empty()
             ? problem_of_corner("corner_east_m", q.west_m, width, extent.first_y_m, extent.last_y_m())
             : north;
}

double onto_edge(double place, double first, double last, double tolerance) {
  const double inside = std::clamp(place, first, last);
  return std::abs(place - inside) <= tolerance ? inside : place;
}

Tile sampled(const Terrain& terrain, const TileQuery& query) {
  const GridGeometry& extent = terrain.extent();
  const double tolerance = kRounding * query.spacing_m;
  Tile tile{.query = query};
  for (std::int64_t i = 0; i < query.rows; ++i) {
    const double x = onto_edge(query.south_m + static_cast<double>(i) * query.spacing_m, extent.first_x_m,
                               extent.last_x_m(), tolerance);
    for (std::int64_t j = 0; j < query.columns; ++j) {
      const double y = onto_edge(query.west_m + static_cast<double>(j) * query.spacing_m, extent.first_y_m,
                                 extent.last_y_m(), tolerance);
      const DepthSample sample = terrain.depth_at(x, y);
      const bool known = sample.status == DepthStatus::kOk;
      tile.z_m.push_back(known ? static_cast<float>(sample.z_m) : 0);
      tile.known.push_back(known ? 1 : 0);
    }
  }
  return tile;
}

}  // namespace

Tile answer(const Terrain& terrain, const TileQuery& query) {
  std::string refusal = refusal_of(terrain.extent(), query);
  if (!refusal.empty()) return {.refusal = std::move(refusal)};
  return sampled(terrain, query);
}

Tile overview(const Terrain& terrain) {
  const GridGeometry& extent = terrain.extent();
  const int longest = std::max(extent.cells_x(), extent.cells_y());
  const double cells =
      std::max(1.0, static_cast<double>(longest) / (kMaxOverviewPosts - 1));  // cells between posts
  const auto posts = [&](int all) {
    return static_cast<std::int64_t>(std::floor(all / cells + kRounding)) + 1;
  };
  return sampled(terrain, {extent.first_x_m, extent.first_y_m, cells * extent.spacing_m,
                           posts(extent.cells_x()), posts(extent.cells_y())});
}

double finest_spacing_m(const Terrain& terrain) {
  double finest = terrain.extent().spacing_m;
  for (std::size_t i = 1; i < terrain.grid_count(); ++i)
    finest = std::min(finest, terrain.grid(i).geometry().spacing_m);
  return finest;
}

}  // namespace halocline::bathymetry
