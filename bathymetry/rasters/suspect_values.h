// SPDX-License-Identifier: BSD-3-Clause
// Detection of raster values that cannot be depths: no data that the file does not declare.
//
// Rules. A value deeper than 12 000 m or higher than 9 500 m is no data (the deepest sea is 10 935 m, the
// highest mountain 8 849 m). 999 and 9999 of either sign are usual marks of no data, but real depths too, on
// a slope and in a trench. Connected posts with the same mark are judged together, by the other posts around
// them:
// - 9999 is a mark when no post around lies within 2000 m of it, or when there are none.
// - 999 is a mark when all posts around differ from it by more than 50 m, and by more than ten times the step
//   that 95 % of neighbouring posts keep.
//
// A rule "below -9999" would cut off trenches.
#pragma once

#include <cstddef>

#include "bathymetry/rasters/raster_source.h"

namespace halocline::bathymetry {

// Replaces suspect values by NaN and returns their number. depths_m are in metres before the datum offset, of
// either sign.
std::size_t remove_suspects(RasterWindow& window);

}  // namespace halocline::bathymetry
