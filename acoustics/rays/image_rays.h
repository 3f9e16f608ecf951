// SPDX-License-Identifier: BSD-3-Clause
// Eigenrays between two points of water of one sound speed over a flat bottom, by the method of images.
//
// Model (Jensen, Kuperman, Porter and Schmidt 2011, section 2.4). Surface and bottom act as mirrors, so each
// path is a straight line to an image of the receiver. With u the depth of the upper end, s the difference in
// depth of the two ends and d the height of the lower end above the bottom, the images lie at the vertical
// distances
//   2 (n + i) u + (2 n + 1) s + 2 (n + j) d,  i, j = 0 or 1,  n = 0, 1, ...
// Accuracy: exact; delays to 1e-15 relative.
#pragma once

#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/layered_rays.h"

namespace halocline::acoustics {

// Returns all eigenrays of `link`, by rising delay. The water has to have one sound speed down to
// the bottom; otherwise throws InvalidArgument.
std::vector<Eigenray> image_rays(const FlatSea& sea, const RayLink& link);

}  // namespace halocline::acoustics
