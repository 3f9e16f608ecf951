// SPDX-License-Identifier: BSD-3-Clause
// Windows of posts: how large one is, and what follows its reading, whoever reads. Part of the module
// halocline_rasters.so.
#pragma once

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/rasters/raster_source.h"

namespace halocline::bathymetry {

// The posts about low..high, of columns `first` to `last` and `rows` rows, without depths yet; empty where
// they do not meet.
RasterWindow window_between(const PixelPosition& low, const PixelPosition& high, int first, int last,
                            int rows);

// Suspects go (suspect_values.h), unless every value is trusted, and the datum's offset is added.
void finish(RasterWindow& window, const RasterOptions& options, PostCounts& counts);

}  // namespace halocline::bathymetry
