// SPDX-License-Identifier: BSD-3-Clause
// Loader of bathymetry: resamples any raster that GDAL opens to a grid in the scenario's local frame, once,
// at load. This is the only part of the terrain that reads files.
//
// Model. Each post of the grid is mapped to the earth (local_frame.h), then to the raster's coordinate system
// (PROJ) and to positions among its posts. Its depth is interpolated bilinearly between the four posts around
// it; where one of those has no data, the post has none. In enu mode the position on the earth depends on the
// post's own depth: three rounds of a fixed-point iteration leave less than 1 mm. In flat mode, blocks of 16
// x 16 posts are mapped by their corners wherever the error is below 1e-4 of a pixel.
//
// GEBCO (pixel centres), its older grid and ETOPO5 (nodes), EMODnet, ESRI ASCII and GeoTIFF are read as they
// declare themselves; see raster_options.h for what files do not state.
//
//   const LocalFrame frame(FrameMode::kFlat, to_radians(29.9167), to_radians(-28.4167));
//   const LoadedRaster loaded = load_raster({.path = "etopo5.cdf"}, frame, {-8000, -8000, 20, 801, 801});
//   const Terrain terrain(loaded.grid);
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/local_frame.h"

namespace halocline::bathymetry {

// Report on a raster that was read, for the log and the record of a run.
struct RasterReport {
  std::string path;
  std::string coordinate_system;
  std::string vertical_datum;
  double datum_offset_m = 0;
  int raster_columns = 0, raster_rows = 0;  // size of the whole file
  int window_columns = 0, window_rows = 0;  // part that was read
  std::size_t declared_no_data = 0;         // posts of the window
  std::size_t undeclared_no_data = 0;       // posts of the window taken as no data, undeclared
  std::size_t posts_without_depth = 0;      // posts of the grid
  std::size_t posts_above_datum = 0;  // posts of the grid: land; if all are, the file may be positive down
  double shallowest_m = 0, deepest_m = 0;  // z over the grid
  std::vector<std::string> warnings = {};  // from opening the file, and about its values
};

struct LoadedRaster {
  HeightGrid grid;
  RasterReport report;
};

// Throws InvalidArgument when the file cannot be read, does not state its position, or covers no post at all.
LoadedRaster load_raster(const RasterOptions& options, const LocalFrame& frame, const GridGeometry& geometry);

// Loads a raster whose coordinates already are local metres (coordinate_system "local") post by post, without
// resampling. Throws InvalidArgument also when its pixels are not square.
LoadedRaster load_local_raster(const RasterOptions& options);

}  // namespace halocline::bathymetry
