// SPDX-License-Identifier: BSD-3-Clause
// A map of coverage as a file, its kind by the name's ending: .tif GeoTIFF, .nc netCDF after the CF
// conventions 1.8, .geojson contours, .png a picture.
//
// The grid's reference system is that of the scenario's local frame: a transverse Mercator projection about
// its origin, or with a tangent plane (frame = "enu") an orthographic one, both on WGS 84; x is east and y
// north of the origin, m.
#pragma once

#include <string>
#include <vector>

#include "bathymetry/terrain/local_frame.h"
#include "clients/halocline/coverage/coverage.h"

namespace halocline::clients {

struct CoverageFile {
  std::vector<CoverageQuantity> quantities;
  bathymetry::LocalFrame frame;
  std::string title;  // one line
};

// Throws InvalidArgument, with what is allowed, unless the name has one of these endings.
void require_coverage_file(const std::string& path);

// Replaces the file. Throws InvalidArgument as above; std::runtime_error when it cannot be written.
void write_coverage(const Coverage& coverage, const CoverageFile& file, const std::string& path);

// The reference system as PROJ and GDAL read it.
std::string reference_system(const bathymetry::LocalFrame& frame);

// What the module halocline_coverage_files.so exports, as halocline_write_coverage_geotiff, _geojson and
// _netcdf.
using CoverageWriter = void(const Coverage& coverage, const CoverageFile& file, const std::string& path);

// GeoTIFF: a band for each quantity and depth, in this order; 32-bit floating point, no data is NaN.
// GeoJSON (RFC 7946: longitudes and latitudes): lines of equal value, with quantity, value and depth_m; of
// delivery at 0.1, 0.25, 0.5, 0.75 and 0.9, of others at 5 to 20 round numbers.

// The picture: a map of each quantity at the best depth, and mean delivery against depth. Throws as
// run_gnuplot (plot/plot.h).
void write_coverage_picture(const Coverage& coverage, const CoverageFile& file, const std::string& path);

}  // namespace halocline::clients
