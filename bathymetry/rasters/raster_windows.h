// SPDX-License-Identifier: BSD-3-Clause
// Windows of raster posts: their bounds, and the steps after reading, for every kind of source. Part of the
// module halocline_rasters.so.
#pragma once

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/rasters/raster_source.h"

namespace halocline::bathymetry {

// Returns the window of posts around low..high, within columns `first` to `last` and `rows` rows, without
// depths yet; empty where they do not meet.
RasterWindow window_between(const PixelPosition& low, const PixelPosition& high, int first, int last,
                            int rows);

// Removes suspect values (suspect_values.h), unless every value is trusted, and adds the datum offset.
void finish(RasterWindow& window, const RasterOptions& options, PostCounts& counts);

}  // namespace halocline::bathymetry
