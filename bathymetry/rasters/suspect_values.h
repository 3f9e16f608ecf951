// SPDX-License-Identifier: BSD-3-Clause
// Finds values of a raster that cannot be depths: no data that the file does not declare.
//
// Rule: a value deeper than 12 000 m or higher than 9 500 m is none (the deepest sea is 10 935 m, the highest
// mountain 8 849 m). -9999 and 9999, the usual marks, are real depths too, in a trench: such a post is taken
// as a mark unless a neighbour that is none lies within 2000 m of it. A rule "below -9999" would cut trenches
// off.
#pragma once

#include <cstddef>

#include "bathymetry/rasters/raster_source.h"

namespace halocline::bathymetry {

// Turns suspects into NaN; depths_m are metres before the datum offset, either sign. Returns how many.
std::size_t remove_suspects(RasterWindow& window);

}  // namespace halocline::bathymetry
