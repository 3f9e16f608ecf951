// SPDX-License-Identifier: BSD-3-Clause
// Waves of a fully developed sea (Pierson and Moskowitz 1964), as they matter to ends and paths of sound near
// the surface.
//
// The elevation is Gaussian with the rms height sigma = 0.22 U^2 / (4 g) and the peak frequency
// omega_p = 0.877 g / U; the mean frequency is omega_m = omega_p / 0.71, g = 9.8 m/s^2. Orbits of the waves
// decay with depth as exp(-omega_m^2 z / g).
//
//   const SurfaceWaves waves = surface_waves(14);
//   const double under = waves.share_under_water(0.5);  // 0.6753 of the time
#pragma once

namespace halocline::acoustics {

struct SurfaceWaves {
  double rms_height_m = 0;          // sigma; 0 without wind
  double mean_frequency_radps = 0;  // omega_m
  double wavelength_m = 0;          // of the peak, 2 pi g / omega_p^2

  // Share of the time for which the surface lies above a place of mean depth z, m: Phi(z / sigma). Without
  // waves 1 from the surface down, else 0.
  double share_under_water(double depth_m) const;
  // Probability that waves leave a path clear whose least depth is d and that runs for the length l above
  // 3 sigma: Phi(d / sigma)^(1 + l / wavelength). The exponent, one independent chance for each wavelength,
  // is a choice.
  double clear_share(double least_depth_m, double length_above_m) const;
  // rms vertical velocity of the water at a mean depth z, m/s: sigma omega_m exp(-omega_m^2 z / g).
  double heave_mps(double depth_m) const;
};

// Waves under a wind of 0..60 m/s.
SurfaceWaves surface_waves(double wind_mps);

}  // namespace halocline::acoustics
