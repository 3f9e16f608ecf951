// SPDX-License-Identifier: BSD-3-Clause
// One path of sound from transmitter to receiver, as received.
#pragma once

#include <cstdint>

#include "acoustics/fading/path_fading.h"
#include "core/units.h"

namespace halocline::acoustics {

struct SoundPath {
  double delay_s = 0;
  Decibels level;             // received: mean power of this path alone
  double doppler_factor = 1;  // f_rx / f_tx, above 0
  double launch_angle_rad = 0;
  double arrival_angle_rad = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  double phase_rad = 0;        // phase of reflections and caustics, without the phase of the delay
  std::uint64_t identity = 0;  // unchanged for both directions of a link and under small motions of its ends
  PathFading fading = {};
  bool diffuse = false;  // not one path but many weak ones in a window of angles (acoustics/rays/eigenray.h)
};

}  // namespace halocline::acoustics
