// SPDX-License-Identifier: BSD-3-Clause
// One eigenray as the receiver gets it: with both beams, the scattering loss and the fading due to
// rough boundaries, and the Doppler shift due to both ends.
#pragma once

#include <optional>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/near_surface.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/surface_ends.h"
#include "core/units.h"

namespace halocline::channel_server {

// Parameters of fading and scattering besides the water.
struct RoughBoundaries {
  acoustics::FadingModel fading;
  double trapped_share;  // see acoustics/fading/reverberation.h
};

// Returns the same path followed from its other end.
acoustics::Eigenray backwards(acoustics::Eigenray path);

// Returns the path as received; empty when no energy is left. `reversed`: the eigenray was found from the
// receiver to the transmitter.
std::optional<Arrival> arrival_of(const RoughBoundaries& boundaries,
                                  const acoustics::Environment& environment, const EndPair& ends,
                                  const acoustics::Eigenray& eigenray, bool reversed);

// Passage of a link's paths by bubbles and waves near the surface. Refers to its arguments.
class SurfacePassage {
 public:
  SurfacePassage(const SurfaceEnds& surface, const acoustics::Environment& environment, const EndPair& ends,
                 double frequency_hz);

  // Takes the loss by bubbles from an eigenray of `link`, which was traced in `water`.
  acoustics::SurfaceCrossing cross(const acoustics::RayWater& water, const acoustics::RayLink& link,
                                   acoustics::Eigenray& path) const;
  // Sets level and fading of the path as received: behind crests, and with the heave of both ends.
  void set_waves(const acoustics::SurfaceCrossing& crossing, Arrival& arrival) const;

 private:
  acoustics::NearSurface surface_;
  double waves_radps_;            // mean frequency of the waves
  double from_shift_, to_shift_;  // heave of the ends over the speed of sound, times the frequency, Hz
};

// Returns the loss by the keels of ice along a path over `range_m` in water of a mean depth, dB.
Decibels keel_loss(const acoustics::Environment& environment, double depth_m, double range_m);

// Returns the share of the path's power that scattering at the surface leaves in it, dB, 0 or less.
Decibels kept_at_surface(const RoughBoundaries& boundaries, const acoustics::Environment& environment,
                         double frequency_hz, const acoustics::Eigenray& eigenray);

}  // namespace halocline::channel_server
