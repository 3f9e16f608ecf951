// SPDX-License-Identifier: BSD-3-Clause
// Restrictions on what GDAL may open: raster files come from strangers, and GDAL follows references inside of
// them.
//
// Unless the user allows any raster (raster_options.h: is_any_raster_allowed):
// - Only formats of elevation data are enabled, none of which refers to other data sets or servers: no WMS,
//   no VRT, no HTTP.
// - GDAL's virtual files ("/vsicurl/...", "/vsizip/...", "/vsistdin/") are refused wherever such a name
//   occurs, except those in memory.
// - A raster must be a regular file and, if it is netCDF, complete (ocean/netcdf_header.h).
// - PROJ does not download grids.
#pragma once

#include <string>

namespace halocline::bathymetry::gdal {

// Applies the restrictions; must be called before anything is opened. Only the first call has an effect.
void prepare_access();

// Returns the drivers that may open a raster, for GDALOpenEx; null: all of GDAL's.
const char* const* allowed_drivers();

// Throws InvalidArgument with the reason when the path must not be opened.
void require_allowed(const std::string& path);

}  // namespace halocline::bathymetry::gdal
