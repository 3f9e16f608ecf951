// SPDX-License-Identifier: BSD-3-Clause
// Coverage maps as files. The ending of the name selects the format: .tif GeoTIFF, .nc netCDF after the CF
// conventions 1.8, .geojson contours, .png a picture.
//
// The reference system of the grid is that of the scenario's local frame: a transverse Mercator projection
// about its origin, or an orthographic projection for a tangent plane (frame = "enu"), both on WGS 84. x is
// east and y is north of the origin, m.
#pragma once

#include <string>
#include <vector>

#include "bathymetry/terrain/local_frame.h"
#include "simulation/coverage/coverage.h"

namespace halocline::clients {

// Contents and georeference of a file.
struct CoverageFile {
  std::vector<CoverageQuantity> quantities;
  bathymetry::LocalFrame frame;
  std::string title;  // one line
};

// Throws InvalidArgument that states what is allowed unless the name has one of these endings.
void require_coverage_file(const std::string& path);

// Writes the map; replaces the file. Throws InvalidArgument as above; std::runtime_error when it cannot be
// written. Contents:
//
// GeoTIFF: one band for each quantity and depth, in this order; 32-bit floating point, NaN means no data.
//
// GeoJSON (RFC 7946: longitudes and latitudes): contour lines with quantity, value and depth_m; delivery at
// 0.1, 0.25, 0.5, 0.75 and 0.9, other quantities at 5 to 20 round values.
void write_coverage(const Coverage& coverage, const CoverageFile& file, const std::string& path);

// Returns the reference system as text that PROJ and GDAL read.
std::string reference_system(const bathymetry::LocalFrame& frame);

// Type of the functions that the module halocline_coverage_files.so exports:
// halocline_write_coverage_geotiff, _geojson and _netcdf.
using CoverageWriter = void(const Coverage& coverage, const CoverageFile& file, const std::string& path);

// Writes a picture: a map of each quantity at the best depth, and the mean delivery against depth. Throws as
// run_gnuplot (plot/plot.h).
void write_coverage_picture(const Coverage& coverage, const CoverageFile& file, const std::string& path);

}  // namespace halocline::clients
