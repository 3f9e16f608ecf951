// SPDX-License-Identifier: BSD-3-Clause
// Rasters of netCDF whose axes of latitude and longitude are unevenly spaced, or stand in the other order:
// GDAL takes the first as even between their ends (kilometres off for a Mercator grid), and the second for
// something else.
//
// Posts are interpolated between their own latitudes and longitudes. Rows run from south to north. Where the
// grid goes round the earth, its seam is opposite of the origin. Part of the module halocline_rasters.so.
#pragma once

#include <memory>

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/rasters/raster_source.h"

namespace halocline::bathymetry {

// Null where GDAL reads the file rightly, or it is no netCDF. Throws InvalidArgument for a file that is cut
// short, for uneven axes of a projection, and for positions in two dimensions.
std::unique_ptr<RasterSource> open_uneven_netcdf(const RasterOptions& options, double origin_latitude_deg,
                                                 double origin_longitude_deg);

}  // namespace halocline::bathymetry
