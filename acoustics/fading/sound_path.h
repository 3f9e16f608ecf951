// SPDX-License-Identifier: BSD-3-Clause
// One path of sound from transmitter to receiver, as the receiver gets it.
#pragma once

#include <cstdint>

#include "acoustics/fading/path_fading.h"
#include "core/units.h"

namespace halocline::acoustics {

struct SoundPath {
  double delay_s = 0;
  Decibels level;             // received, mean power of this path alone
  double doppler_factor = 1;  // f_rx / f_tx, above 0
  double launch_angle_rad = 0;
  double arrival_angle_rad = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  double phase_rad = 0;        // of its reflections and caustics, beside that of the delay
  std::uint64_t identity = 0;  // the same for both directions of a link, and while its ends move a little
  PathFading fading = {};
  bool diffuse = false;  // not one path: many weak ones in a window of angles (acoustics/rays/arrivals.h)
};

}  // namespace halocline::acoustics
