// SPDX-License-Identifier: BSD-3-Clause
// Recipe of a scenario's terrain: a base grid from a shape or a raster, relief on top, and finer grids nested
// in it.
//
// Order: the base is made (a shape is sampled, or a raster resampled once into the local frame), relief is
// added, and nested grids are read and blended in, each with relief of its own. Relief is synthetic and
// labelled so in the summary. The relief of a nested grid equals that of the base where both have the same
// octaves, because relief is a function of position. A shape and its relief continue beyond the grid without
// end, at the grid's spacing; a raster ends at the edge of its grid.
//
//   const PreparedTerrain prepared = prepare_terrain(recipe, {29.9167, -28.4167});
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/terrain/fractal_relief.h"
#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/local_frame.h"
#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry {

enum class TerrainKind { kFlat, kSlope, kRidge, kSeamount, kRaster };

// Rectangle of posts around a centre, local NED.
struct DomainRecipe {
  double center_north_m = 0, center_east_m = 0;
  double size_north_m = 4000, size_east_m = 4000;  // whole multiples of the spacing
  double spacing_m = 20;

  // Returns the grid, whose posts lie symmetrically about the centre. Throws InvalidArgument unless
  // is_possible().
  GridGeometry geometry() const;
  // True when both sizes are whole multiples of the spacing, at least one.
  [[nodiscard]] bool is_possible() const;
};

struct NestedRecipe {
  DomainRecipe domain = {};
  double blend_width_m = 200;
  Holes holes = Holes::kKeep;
  RasterOptions raster = {};
};

struct TerrainRecipe {
  TerrainKind kind = TerrainKind::kFlat;
  FrameMode frame = FrameMode::kFlat;  // used by rasters
  DomainRecipe domain = {};
  FlatShape flat;
  SlopeShape slope;
  RidgeShape ridge;
  SeamountShape seamount;
  RasterOptions raster = {};
  bool whole_file = false;  // a local raster with its own posts; `domain` is ignored
  // No relief when rms_m is 0.
  FractalRelief relief{
      .rms_m = 0, .longest_wavelength_m = 500, .shortest_wavelength_m = 50, .hurst = 0.9, .seed = 1};
  std::vector<NestedRecipe> nested;

  // True for a level bottom, which any grid represents.
  bool is_level() const { return kind == TerrainKind::kFlat && relief.rms_m == 0 && nested.empty(); }
};

// Geodetic origin of the scenario.
struct Site {
  double origin_latitude_deg = 0, origin_longitude_deg = 0;
};

struct PreparedTerrain {
  std::shared_ptr<const Terrain> terrain;
  std::vector<RasterReport> rasters;  // in the order of reading, base first; empty for generated terrain
  std::string summary;                // one line for a reader
};

// Returns the memory of the recipe's grids, bytes: posts, and the pyramid of each; grids of whole_file are
// not counted. Throws InvalidArgument for an impossible recipe, and when its grids together have more than
// 2^30 posts.
double memory_of(const TerrainRecipe& recipe);

// Builds the terrain. Throws InvalidArgument for an impossible recipe, for rasters that cannot be read, and
// when it needs more than the available memory.
PreparedTerrain prepare_terrain(const TerrainRecipe& recipe, const Site& site);

// Returns the mean depth of the water over the terrain's area, m, from 9 x 9 places of the base without
// relief and nested grids: cheap, and enough to tell a shelf from the deep sea. Places on land are left out;
// 0 when all are. Throws InvalidArgument for rasters that cannot be read.
double mean_water_depth_m(const TerrainRecipe& recipe, const Site& site, double sea_surface_z_m);

// Returns the extent of the terrain for a reader: "north -2000 to 2000 m, east -2000 to 2000 m".
std::string extent_text(const Terrain& terrain);

// Returns the version as sent on the bus: 16 hexadecimal digits.
std::string version_text(std::uint64_t version);

}  // namespace halocline::bathymetry
