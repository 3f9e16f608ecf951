// SPDX-License-Identifier: BSD-3-Clause
// A sound-speed profile moved by the two gravest modes of the water column, for members of ensembles.
//
// Model: over the upper H m, z below the surface,
//   dc(z) = a_1 cos(pi z / H) + a_2 cos(2 pi z / H),
// and from H to 1.25 H what dc has there, falling linearly to 0 (a choice). In water of known temperature the
// temperature moves so that the speed does, so absorption follows. dc is linear between 8 rows added over H:
// off by at most 0.08 of a_2.
#pragma once

#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {

// Amplitudes, m/s, and the height over which they act, m, 1 to 12 000; both amplitudes 0: the profile as it
// is.
struct ProfileModes {
  double first_mps = 0, second_mps = 0, height_m = 200;
};

// Returns the profile with these modes. `latitude_rad` is that of its water (-pi/2..pi/2). Temperatures and
// speeds are held within the ranges of a profile's rows.
SoundSpeedProfile with_modes(const SoundSpeedProfile& profile, const ProfileModes& modes,
                             double latitude_rad);

}  // namespace halocline::acoustics
