// SPDX-License-Identifier: BSD-3-Clause
// Whether a raster holds depths or heights, by what its file declares (CF 1.10: positive and standard_name)
// and its options.
#pragma once

#include <string>

#include "bathymetry/rasters/raster_options.h"

namespace halocline::bathymetry {

// True for depths. Empty texts declare nothing. Throws InvalidArgument for contradictions, within the file or
// of its options.
bool holds_depths(const std::string& positive, const std::string& standard_name,
                  const RasterOptions& options);

}  // namespace halocline::bathymetry
