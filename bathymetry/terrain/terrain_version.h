// SPDX-License-Identifier: BSD-3-Clause
// A number for the content of a terrain, by which a client and a server check that they mean the same one.
//
// Model: a 64-bit multiply-rotate hash of our own over geometry and posts, four lanes wide so that 64 MB take
// about 10 ms. Not cryptographic. Little-endian words; NaN posts count as one value, whatever their bits.
#pragma once

#include <cstdint>

#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

// `version` of what came before (0 at first), extended by one more grid.
std::uint64_t extend_version(std::uint64_t version, const HeightGrid& grid);

}  // namespace halocline::bathymetry
