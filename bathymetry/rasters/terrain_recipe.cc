// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/terrain_recipe.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <utility>

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/terrain/endless_bottom.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/local_frame.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/memory/memory_budget.h"
#include "core/text/hex_digits.h"
#include "core/units.h"

namespace halocline::bathymetry {
namespace {

constexpr double kMaxCells = 32'768;  // in each direction

double cells(double size_m, double spacing_m) { return std::round(size_m / spacing_m); }

bool is_whole_multiple(double size_m, double spacing_m) {
  constexpr double kDecimalTolerance = 1e-6;  // in cells: sizes are written in decimals
  const double count = size_m / spacing_m;
  return count >= 1 && count <= kMaxCells && std::abs(count - std::round(count)) <= kDecimalTolerance;
}

// Returns the shape of the base; empty for a raster.
std::optional<Shape> shape_of(const TerrainRecipe& recipe) {
  switch (recipe.kind) {
    case TerrainKind::kFlat:
      return recipe.flat;
    case TerrainKind::kSlope:
      return recipe.slope;
    case TerrainKind::kRidge:
      return recipe.ridge;
    case TerrainKind::kSeamount:
      return recipe.seamount;
    case TerrainKind::kRaster:
      break;
  }
  return std::nullopt;
}

// Returns the base grid. A level bottom has one cell over the area when the spacing does not divide it.
GridGeometry grid_of(const TerrainRecipe& recipe) {
  DomainRecipe domain = recipe.domain;
  if (recipe.is_level() && !domain.is_possible())
    domain.spacing_m = domain.size_north_m = domain.size_east_m =
        std::max(domain.size_north_m, domain.size_east_m);
  return domain.geometry();
}

// Returns the formula of every post of the grid, and of every point beyond it.
BottomFormula formula_of(const TerrainRecipe& recipe, const Shape& shape) {
  if (recipe.relief.rms_m == 0) return [shape](double x_m, double y_m) { return depth_of(shape, x_m, y_m); };
  return [shape, relief = ReliefFormula(recipe.relief, recipe.domain.spacing_m)](double x_m, double y_m) {
    return static_cast<float>(depth_of(shape, x_m, y_m)) + relief(x_m, y_m);
  };
}

HeightGrid base_grid(const TerrainRecipe& recipe, const LocalFrame& frame,
                     std::vector<RasterReport>& reports) {
  if (const auto shape = shape_of(recipe)) return make_grid(grid_of(recipe), *shape);
  const RasterOptions& options = recipe.raster;
  require(!options.path.empty(), "terrain.raster.path is missing; it names a raster file");
  LoadedRaster loaded =
      recipe.whole_file ? load_local_raster(options) : load_raster(options, frame, recipe.domain.geometry());
  reports.push_back(std::move(loaded.report));
  return std::move(loaded.grid);
}

// Returns the grid's rectangle with 9 posts along its longer side.
GridGeometry coarse(const GridGeometry& grid) {
  constexpr int kSteps = 8;
  const double north_m = grid.last_x_m() - grid.first_x_m, east_m = grid.last_y_m() - grid.first_y_m;
  const double spacing_m = std::max(north_m, east_m) / kSteps;
  const auto posts = [spacing_m](double side_m) { return static_cast<int>(side_m / spacing_m) + 1; };
  return {grid.first_x_m, grid.first_y_m, spacing_m, std::max(posts(north_m), 2), std::max(posts(east_m), 2)};
}

std::string summary_of(const TerrainRecipe& recipe, const Terrain& terrain,
                       const std::vector<RasterReport>& reports) {
  static constexpr const char* kNames[] = {"flat", "slope", "ridge", "seamount", "raster"};
  const GridGeometry& g = terrain.extent();
  char text[160];
  std::snprintf(text, sizeof text, ", %d x %d posts %g m apart, %zu grid(s)", g.posts_x, g.posts_y,
                g.spacing_m, terrain.grid_count());
  std::string summary = kNames[static_cast<int>(recipe.kind)] + std::string(text);
  for (const RasterReport& report : reports) {
    std::snprintf(text, sizeof text, " (%s, datum %s, %.0f to %.0f m, %zu posts without depth)",
                  report.coordinate_system.c_str(), report.vertical_datum.c_str(), report.shallowest_m,
                  report.deepest_m, report.posts_without_depth);
    summary += "; " + report.path + text;
  }
  if (recipe.relief.rms_m > 0) {
    std::snprintf(text, sizeof text, "; with SYNTHETIC relief of %g m rms", recipe.relief.rms_m);
    summary += text;
  }
  return summary + "; version " + version_text(terrain.version());
}

}  // namespace

bool DomainRecipe::is_possible() const {
  return spacing_m > 0 && is_whole_multiple(size_north_m, spacing_m) &&
         is_whole_multiple(size_east_m, spacing_m);
}

GridGeometry DomainRecipe::geometry() const {
  require(is_possible(), "the terrain's size must be 1 to 32768 whole multiples of its spacing, both ways");
  return {center_north_m - 0.5 * size_north_m, center_east_m - 0.5 * size_east_m, spacing_m,
          static_cast<int>(cells(size_north_m, spacing_m)) + 1,
          static_cast<int>(cells(size_east_m, spacing_m)) + 1};
}

std::string version_text(std::uint64_t version) { return hex_digits(version); }

std::string extent_text(const Terrain& terrain) {
  const GridGeometry& g = terrain.extent();
  char text[120];
  std::snprintf(text, sizeof text, "north %g to %g m, east %g to %g m", g.first_x_m, g.last_x_m(),
                g.first_y_m, g.last_y_m());
  return text;
}

double memory_of(const TerrainRecipe& recipe) {
  constexpr double kBytesAPost = sizeof(float) * 4.0 / 3;  // shallowest_pyramid.h
  std::vector<GridGeometry> grids;
  if (recipe.kind != TerrainKind::kRaster || !recipe.whole_file) grids.push_back(grid_of(recipe));
  for (const NestedRecipe& inner : recipe.nested) grids.push_back(inner.domain.geometry());
  double posts = 0;
  for (const GridGeometry& grid : grids) {
    posts += static_cast<double>(grid.posts_x) * grid.posts_y;
  }
  require(posts <= static_cast<double>(kMaxTerrainPosts),
          "the terrain's grids have " + format_number(posts) +
              " posts in all, more than 2^30; take smaller domains or a wider spacing");
  return posts * kBytesAPost;
}

double mean_water_depth_m(const TerrainRecipe& recipe, const Site& site, double sea_surface_z_m) {
  const auto shape = shape_of(recipe);
  const LocalFrame frame(recipe.frame, to_radians(site.origin_latitude_deg),
                         to_radians(site.origin_longitude_deg));
  const HeightGrid grid = shape ? make_grid(coarse(grid_of(recipe)), *shape)
                          : recipe.whole_file
                              ? load_local_raster(recipe.raster).grid
                              : load_raster(recipe.raster, frame, coarse(recipe.domain.geometry())).grid;
  double sum_m = 0, count = 0;
  for (const float z_m : grid.posts()) {
    const double depth_m = z_m - sea_surface_z_m;
    if (!(depth_m > 0)) continue;  // land, or no data
    sum_m += depth_m;
    ++count;
  }
  return count > 0 ? sum_m / count : 0;
}

PreparedTerrain prepare_terrain(const TerrainRecipe& recipe, const Site& site) {
  require_memory(memory_of(recipe), "the terrain", "take a smaller domain or a wider spacing");
  const LocalFrame frame(recipe.frame, to_radians(site.origin_latitude_deg),
                         to_radians(site.origin_longitude_deg));
  PreparedTerrain prepared;
  HeightGrid base = base_grid(recipe, frame, prepared.rasters);
  const bool rough = recipe.relief.rms_m > 0;
  if (rough) add_relief(recipe.relief, base);
  std::vector<NestedGrid> nested;
  for (const NestedRecipe& inner : recipe.nested) {
    require(!inner.raster.path.empty(), "terrain.nested.raster.path is missing; it names a raster file");
    LoadedRaster loaded = load_raster(inner.raster, frame, inner.domain.geometry());
    if (rough) add_relief(recipe.relief, loaded.grid);
    prepared.rasters.push_back(std::move(loaded.report));
    nested.push_back({std::move(loaded.grid), inner.blend_width_m, inner.holes});
  }
  const std::optional<Shape> shape = shape_of(recipe);
  prepared.terrain = std::make_shared<const Terrain>(std::move(base), std::move(nested),
                                                     shape ? formula_of(recipe, *shape) : BottomFormula());
  prepared.summary = summary_of(recipe, *prepared.terrain, prepared.rasters);
  return prepared;
}

}  // namespace halocline::bathymetry
