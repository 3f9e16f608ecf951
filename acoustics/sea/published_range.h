// SPDX-License-Identifier: BSD-3-Clause
// The ranges of input for which formulas of the sea were published. Outside of them a formula is evaluated
// all the same: whoever shows results to a person says so.
//
// Sources: the headers of the formulas (sound_speed.h, absorption.h, noise.h, boundary_reflection.h). An end
// that its author does not state is infinite. Values: calls may overlap between threads.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed.h"

namespace halocline::acoustics {

struct PublishedRange {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool holds(double value) const { return lowest <= value && value <= highest; }
};

// Of sound speed. A formula takes depth or pressure: the other is unlimited.
struct PublishedWater {
  PublishedRange temperature_degc, salinity_psu, depth_m, pressure_dbar;
};
PublishedWater published_water(SoundSpeedModel model);

struct PublishedAbsorption {
  PublishedRange frequency_hz, temperature_degc, salinity_psu, depth_m, ph;
};
PublishedAbsorption published_absorption(AbsorptionModel model);

inline constexpr PublishedRange kPublishedNoiseHz{10, 1e6};
inline constexpr PublishedRange kPublishedMunkDepthM{0, 5000};
PublishedRange published_surface_loss_hz(SurfaceModel model);

// One sentence for each formula that an environment takes beyond its range, for sound in `band` between the
// surface and `deepest_m`; none where all are within.
std::vector<std::string> beyond_published_ranges(const Environment& environment, const Band& band,
                                                 double deepest_m);

}  // namespace halocline::acoustics
