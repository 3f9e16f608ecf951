// SPDX-License-Identifier: BSD-3-Clause
// How a scenario's terrain is made: a base grid from a shape or a raster, relief on top, finer grids nested
// in it.
//
// Order: the base is made (shape sampled, or raster resampled once into the local frame), relief is added,
// nested grids are read and blended in, each with relief of its own. Relief is synthetic and labelled so in
// the summary. A nested grid's relief is that of the base where both hold the same octaves: relief belongs to
// the place. A shape and its relief go on beyond the grid without end, at the grid's spacing; a raster ends
// where its grid does.
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

// A rectangle of posts around a centre, local NED.
struct DomainRecipe {
  double center_north_m = 0, center_east_m = 0;
  double size_north_m = 4000, size_east_m = 4000;  // whole multiples of the spacing
  double spacing_m = 20;

  // The grid; its posts lie symmetrically about the centre. Throws InvalidArgument unless it is possible.
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
  FrameMode frame = FrameMode::kFlat;  // for rasters
  DomainRecipe domain = {};
  FlatShape flat;
  SlopeShape slope;
  RidgeShape ridge;
  SeamountShape seamount;
  RasterOptions raster = {};
  bool whole_file = false;  // a local raster as it is: its own posts, `domain` is not looked at
  // rms_m 0: none.
  FractalRelief relief{
      .rms_m = 0, .longest_wavelength_m = 500, .shortest_wavelength_m = 50, .hurst = 0.9, .seed = 1};
  std::vector<NestedRecipe> nested;

  // A level bottom, for which any grid will do.
  bool is_level() const { return kind == TerrainKind::kFlat && relief.rms_m == 0 && nested.empty(); }
};

// Where the scenario lies.
struct Site {
  double origin_latitude_deg = 0, origin_longitude_deg = 0;
};

struct PreparedTerrain {
  std::shared_ptr<const Terrain> terrain;
  std::vector<RasterReport> rasters;  // as read, base first; empty for generated terrain
  std::string summary;                // one line for a person
};

// Bytes of memory that the grids of a recipe take, those of whole_file not counted: posts, and the pyramid of
// each. Throws InvalidArgument for an impossible recipe, and where its grids together have more than 2^30
// posts.
double memory_of(const TerrainRecipe& recipe);

// Throws InvalidArgument for an impossible recipe, for rasters that cannot be read and for more than the
// memory that is there.
PreparedTerrain prepare_terrain(const TerrainRecipe& recipe, const Site& site);

// Where it lies, for a person: "north -2000 to 2000 m, east -2000 to 2000 m".
std::string extent_text(const Terrain& terrain);

// The version as it travels on the bus: 16 hexadecimal digits.
std::string version_text(std::uint64_t version);

}  // namespace halocline::bathymetry
