// SPDX-License-Identifier: BSD-3-Clause
// What GDAL may open: a file comes from strangers, and GDAL follows what stands in it.
//
// Without the user's word (raster_options.h: is_any_raster_allowed)
// - the formats of elevation data alone are known, none of which names other data sets or servers: no WMS, no
//   VRT, no HTTP;
// - GDAL's virtual files ("/vsicurl/...", "/vsizip/...", "/vsistdin/") are refused wherever a name of one
//   stands, but for memory;
// - a raster is a regular file, and where it is netCDF, whole (ocean/netcdf_header.h);
// - PROJ fetches no grids.
#pragma once

#include <string>

namespace halocline::bathymetry::gdal {

// Before anything is opened; each call has effect once.
void prepare_access();

// The drivers that may open a raster, for GDALOpenEx; null: all that GDAL has.
const char* const* allowed_drivers();

// Throws InvalidArgument with what the path is.
void require_allowed(const std::string& path);

}  // namespace halocline::bathymetry::gdal
