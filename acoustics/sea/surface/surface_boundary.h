// SPDX-License-Identifier: BSD-3-Clause
// The sea surface as a boundary that scatters: one description for waves with bubbles and for ice.
//
// A bounce at the grazing angle theta keeps the share 10^(-loss_db / 10) of its power; of that the share
// exp(-Gamma^2), Gamma = 2 k rms_height_m sin(theta), stays coherent and the rest is turned by facets whose
// slope in the plane of the sound is normal with the variance `slope_variance`.
//   waves  rms height of Pierson and Moskowitz; slope_variance = 0.5 * 4.6e-3 ln(2.1 U^2), U >= 1 (half of
//          all: total slope of waves long against the sound's, APL-UW TR 9407, part II); bubbles as there, at
//          most kMaxBubbleBounceDb a bounce
//   ice    the numbers of its cover (ice_cover.h)
//
//   const SurfaceBoundary rough = surface_boundary(10, {}, 25'000);
//   const double kept = rough.kept_power(0.2);  // B of a bounce
#pragma once

#include "acoustics/sea/ice_cover.h"

namespace halocline::acoustics {

struct SurfaceBoundary {
  double rms_height_m = 0;
  double slope_variance = 0;
  double mean_frequency_radps = 0;           // of the surface's motion; 0: it does not move
  bool is_still = false;                     // fast ice: what it scatters changes within hours only
  double bubbles_db = 0;                     // loss of a bounce by bubbles at a sine of 1
  double loss_db = 0, loss_per_sine_db = 0;  // loss of a bounce under ice

  // Loss of one bounce, dB, at the sine of the grazing angle, 0..1.
  double bounce_db(double sine) const;
  // Share of the power that one bounce keeps, 0..1.
  double kept_power(double sine) const;
};

// Mean angular frequency of the waves under `wind_mps` > 0, rad/s, with g = 9.81 m/s^2.
double mean_wave_frequency_radps(double wind_mps);

// Variance of the waves' slope in a plane under a wind of 0..60 m/s.
double wave_slope_variance(double wind_mps);

// Boundary under a wind of 0..60 m/s or, where there is ice, under the ice, at a frequency of 10..1e6 Hz.
SurfaceBoundary surface_boundary(double wind_mps, const IceCover& ice, double frequency_hz);

}  // namespace halocline::acoustics
