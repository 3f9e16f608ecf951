// SPDX-License-Identifier: BSD-3-Clause
// One path that rays found, as the receiver gets it: with both beams, with what rough boundaries leave of it
// and how they make it fade, and with the Doppler of both ends.
#pragma once

#include <optional>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/propagation.h"
#include "core/units.h"

namespace halocline::channel_server {

// What fading and scattering depend on besides the water.
struct RoughBoundaries {
  acoustics::FadingModel fading;
  double trapped_share;  // of acoustics/fading/scattering_loss.h
};

// The same path, followed from its other end.
acoustics::Arrival backwards(acoustics::Arrival path);

// `reversed`: the arrival was found from the receiver to the transmitter. Empty where nothing is left of it.
std::optional<SoundPath> received_path(const RoughBoundaries& boundaries,
                                       const acoustics::Environment& environment, const EndPair& ends,
                                       const acoustics::Arrival& arrival, bool reversed);

// Of the level of that path, what the surface's scattering leaves, 0 dB or less.
Decibels kept_at_surface(const RoughBoundaries& boundaries, const acoustics::Environment& environment,
                         double frequency_hz, const acoustics::Arrival& arrival);

}  // namespace halocline::channel_server
