// SPDX-License-Identifier: BSD-3-Clause
// Every ray between two points of water of one sound speed over a flat bottom: the sum of images.
//
// Model: surface and bottom are mirrors, so each path is a straight line to an image of the receiver. With u
// the depth of the upper end, s the difference of both and d the height of the lower one above the bottom,
// images lie 2 (n + i) u + (2 n + 1) s + 2 (n + j) d away vertically, i, j = 0 or 1, n = 0, 1, ... (Jensen,
// Kuperman, Porter and Schmidt 2011, section 2.4). Exact; delays to 1e-15 relative.
#pragma once

#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/layered_rays.h"

namespace halocline::acoustics {

// All rays of `link` by rising delay. The water has to be of one speed down to the bottom (InvalidArgument
// otherwise).
std::vector<Arrival> image_rays(const FlatSea& sea, const RayLink& link);

}  // namespace halocline::acoustics
