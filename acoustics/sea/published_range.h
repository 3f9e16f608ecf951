// SPDX-License-Identifier: BSD-3-Clause
// Ranges of input for which the formulas of the sea were published. Outside of them a formula is still
// evaluated; the programs that present results warn about it.
//
// Sources: the headers of the formulas (sound_speed.h, absorption.h, noise.h, boundary_reflection.h). A limit
// that the author does not state is infinite. Values: calls may overlap between threads.
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

// A closed interval, by default unlimited.
struct PublishedRange {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool holds(double value) const { return lowest <= value && value <= highest; }
};

// Ranges of a formula for sound speed. It takes either depth or pressure: the other one is unlimited.
struct PublishedWater {
  PublishedRange temperature_degc, salinity_psu, depth_m, pressure_dbar;
};
PublishedWater published_water(SoundSpeedModel model);

// Ranges of a formula for absorption.
struct PublishedAbsorption {
  PublishedRange frequency_hz, temperature_degc, salinity_psu, depth_m, ph;
};
PublishedAbsorption published_absorption(AbsorptionModel model);

inline constexpr PublishedRange kPublishedNoiseHz{10, 1e6};
inline constexpr PublishedRange kPublishedMunkDepthM{0, 5000};
PublishedRange published_surface_loss_hz(SurfaceModel model);

// One sentence for each formula that is used outside of its range in the given environment, for sound in
// `band` between the surface and `deepest_m`; empty when all are within range.
std::vector<std::string> beyond_published_ranges(const Environment& environment, const Band& band,
                                                 double deepest_m);

}  // namespace halocline::acoustics
