// SPDX-License-Identifier: BSD-3-Clause
// Version number of a terrain's content, by which a client and a server check that they use the same terrain.
//
// Model. A 64-bit multiply-rotate hash of our own over geometry and posts, in four lanes, so that 64 MB take
// about 10 ms. Not cryptographic. Little-endian words; all NaN posts count as one value, whatever their bits.
#pragma once

#include <cstdint>

#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

// Returns the version of the preceding grids (0 at first), extended by one more grid.
std::uint64_t extend_version(std::uint64_t version, const HeightGrid& grid);

}  // namespace halocline::bathymetry
