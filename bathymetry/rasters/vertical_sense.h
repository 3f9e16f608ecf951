// SPDX-License-Identifier: BSD-3-Clause
// Vertical sense of a raster: depths or heights, by the file's declarations (CF 1.10: positive and
// standard_name) and its options.
#pragma once

#include <string>

#include "bathymetry/rasters/raster_options.h"

namespace halocline::bathymetry {

// True for depths. Empty texts declare nothing. Throws InvalidArgument for contradictions within the file, or
// between file and options.
bool holds_depths(const std::string& positive, const std::string& standard_name,
                  const RasterOptions& options);

}  // namespace halocline::bathymetry
