// SPDX-License-Identifier: BSD-3-Clause
// How the slopes of a rough bottom turn rays from one grazing angle to others, bounce by bounce.
//
// Model. A ray of grazing angle theta that meets a slope s leaves with theta + 2 s. With many small slopes of
// the variance s2, met one after the other at random, what rays of one angle bring to a receiver, g(theta),
// changes with the range r as
//   dg/dr = 2 s2 / (X sin theta) d/dtheta (sin theta dg/dtheta) - n g,
// X the length of a cycle (from bottom to bottom), n the power lost in a metre: diffusion in Snell's xi that
// leaves the energy of equally filled angles as it is (of the kind of the master equation of coupled modes:
// Dozier and Tappert 1978, J. Acoust. Soc. Am. 63:353). Solved in even angles by implicit steps of range.
//
// Left out: slopes that are alike from one bounce to the next, as those of a long hillside; whatever turns
// rays at once by more than their own angle only on the mean.
#pragma once

#include <vector>

namespace halocline::acoustics {

// Of the middle of one of the even angles.
struct BottomRay {
  double cycle_m = 1;       // above 0
  double nepers_per_m = 0;  // of power, 0 or more
  double power = 0;         // g, 0 or more, any unit
};

// Takes the rays on by the range. The first is of half of `width_rad`; no ray leaves the angles.
void diffuse_by_slopes(std::vector<BottomRay>& rays, double width_rad, double mean_square_slope,
                       double range_m);

}  // namespace halocline::acoustics
