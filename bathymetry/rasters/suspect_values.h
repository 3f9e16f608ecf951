// SPDX-License-Identifier: BSD-3-Clause
// Finds values of a raster that cannot be depths: no data that the file does not declare.
//
// Rules: a value deeper than 12 000 m or higher than 9 500 m is none (the deepest sea is 10 935 m, the
// highest mountain 8 849 m). 999 and 9999 of either sign, the usual marks, are real depths too, on a slope
// and in a trench. Posts that touch and have the same mark are judged together, by the posts around them that
// are none:
// - 9999 is a mark where none of these lies within 2000 m of it, or there are none;
// - 999 is one where all of these are further than 50 m and than ten times the step that 95 % of neighbours
//   keep. A rule "below -9999" would cut trenches off.
#pragma once

#include <cstddef>

#include "bathymetry/rasters/raster_source.h"

namespace halocline::bathymetry {

// Turns suspects into NaN; depths_m are metres before the datum offset, either sign. Returns how many.
std::size_t remove_suspects(RasterWindow& window);

}  // namespace halocline::bathymetry
