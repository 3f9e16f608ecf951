// SPDX-License-Identifier: BSD-3-Clause
// Raster source for netCDF files whose axes of latitude and longitude are unevenly spaced, or whose dimension
// of longitude precedes that of latitude. GDAL treats uneven axes as even between their ends (kilometres off
// for a Mercator grid), and misinterprets the other order of dimensions.
//
// Depths are interpolated between the actual latitudes and longitudes of the posts. Rows run from south to
// north. Where the grid spans the whole earth, its seam lies opposite of the origin. Part of the module
// halocline_rasters.so.
#pragma once

#include <memory>

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/rasters/raster_source.h"

namespace halocline::bathymetry {

// Returns the source; null where GDAL reads the file correctly or the file is not netCDF. Throws
// InvalidArgument for a truncated file, for uneven axes of a projection, and for two-dimensional positions.
std::unique_ptr<RasterSource> open_uneven_netcdf(const RasterOptions& options, double origin_latitude_deg,
                                                 double origin_longitude_deg);

}  // namespace halocline::bathymetry
