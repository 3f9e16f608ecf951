// SPDX-License-Identifier: BSD-3-Clause
// Arrival: an eigenray from transmitter to receiver, as received.
#pragma once

#include "acoustics/fading/path_fading.h"
#include "acoustics/rays/eigenray.h"
#include "core/units.h"

namespace halocline::acoustics {

// Both directions of a link have the same identity: that of the path from the end of lower id. Of a straight
// path and of a measured one only delay, phase, angles, bounces, length and absorption hold.
struct Arrival : Eigenray {
  Decibels level = {};        // received: mean power of this path alone
  double doppler_factor = 1;  // f_rx / f_tx, above 0
  PathFading fading = {};
};

}  // namespace halocline::acoustics
