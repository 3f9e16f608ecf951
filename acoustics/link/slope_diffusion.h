// SPDX-License-Identifier: BSD-3-Clause
// Diffusion of rays over grazing angles by the slopes of a rough bottom, bounce by bounce.
//
// Model. A ray of grazing angle theta that meets a slope s leaves at theta + 2 s. For many small slopes of
// variance s2, met in random order, the contribution g(theta) of rays of one angle to a receiver changes with
// the range r as
//   dg/dr = 2 s2 / (X sin theta) d/dtheta (sin theta dg/dtheta) - n g,
// X the length of a cycle (from bottom to bottom) and n the power lost per metre. This is a diffusion in
// Snell's xi that preserves the energy of equally filled angles (of the kind of the master equation of
// coupled modes: Dozier and Tappert 1978, J. Acoust. Soc. Am. 63:353). It is solved on equidistant angles by
// implicit steps of range.
//
// Left out: slopes that are correlated from one bounce to the next, as on a long hillside. Slopes that turn a
// ray by more than its own angle at once are represented in the mean only.
#pragma once

#include <vector>

namespace halocline::acoustics {

// Rays about the midpoint of one of the equidistant angles.
struct BottomRay {
  double cycle_m = 1;       // above 0
  double nepers_per_m = 0;  // nepers of power, 0 or more
  double power = 0;         // g, 0 or more, any unit
};

// Advances the rays by the range. The first ray has half of `width_rad` as its angle; no ray leaves the range
// of angles.
void diffuse_by_slopes(std::vector<BottomRay>& rays, double width_rad, double mean_square_slope,
                       double range_m);

}  // namespace halocline::acoustics
