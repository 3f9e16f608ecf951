// SPDX-License-Identifier: BSD-3-Clause
// One eigenray as the receiver gets it: with both beams, the scattering loss and the fading due to
// rough boundaries, and the Doppler shift due to both ends.
#pragma once

#include <optional>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/propagation.h"
#include "core/units.h"

namespace halocline::channel_server {

// Parameters of fading and scattering besides the water.
struct RoughBoundaries {
  acoustics::FadingModel fading;
  double trapped_share;  // see acoustics/fading/scattering_loss.h
};

// Returns the same path followed from its other end.
acoustics::Eigenray backwards(acoustics::Eigenray path);

// Returns the path as received; empty when no energy is left. `reversed`: the eigenray was found from the
// receiver to the transmitter.
std::optional<Arrival> arrival_of(const RoughBoundaries& boundaries,
                                  const acoustics::Environment& environment, const EndPair& ends,
                                  const acoustics::Eigenray& eigenray, bool reversed);

// Returns the share of the path's power that scattering at the surface leaves in it, dB, 0 or less.
Decibels kept_at_surface(const RoughBoundaries& boundaries, const acoustics::Environment& environment,
                         double frequency_hz, const acoustics::Eigenray& eigenray);

}  // namespace halocline::channel_server
