// SPDX-License-Identifier: BSD-3-Clause
// The layers near the surface that a wind makes: waves and bubbles, as they matter to ends and paths of
// sound.
//
// Waves are those of a fully developed sea (Pierson and Moskowitz 1964). The elevation is Gaussian with the
// rms height sigma = 0.22 U^2 / (4 g) and the peak frequency omega_p = 0.877 g / U; the mean frequency is
// omega_m = omega_p / 0.71, g = 9.8 m/s^2. Orbits of the waves decay with depth as exp(-omega_m^2 z / g).
//
// Bubbles attenuate at the depth z by (A0 / L) exp(-z / L) dB/m, with f in kHz and the wind U in m/s:
//
//   A0 = 0.63e-3 max(U, 6)^1.57 f^0.85 dB, below 6 m/s times exp(1.2 (U - 6))
//   L  = 0.4 + 0.115 max(U - 7.5, 0) m
//
// A0, the loss of one vertical way, is half of a bounce of APL-UW TR 9407 (boundary_reflection.h), so that a
// bounce between deep ends comes out the same. L is that of Hall 1989 and of Keiffer, Novarini and Norton
// 1995. Left out: the slower sound among bubbles, and clouds that come and go; because these are patchy a
// path loses at most kMaxBubblePathDb (a choice).
//
//   const double under = surface_waves(14).share_under_water(0.5);  // 0.6753 of the time
//   const double lost_db = bubble_layer(14, 25'000).straight_loss_db(0.5, 20, 500.4);
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

inline constexpr double kMaxBubbleBounceDb = 15;  // greatest loss of one bounce in the transport of power, dB
inline constexpr double kMaxBubblePathDb = 30;    // greatest loss of a path near the surface, dB

struct BubbleLayer {
  double one_way_db = 0;     // A0
  double e_folding_m = 0.4;  // L

  // Attenuation at a depth >= 0, dB/m.
  double db_per_m(double depth_m) const;
  // Loss of a straight path between two depths >= 0 that is `length_m` long, dB:
  //   A0 (exp(-z1 / L) - exp(-z2 / L)) / |z2 - z1| length
  double straight_loss_db(double from_m, double to_m, double length_m) const;
};

// Layer under a wind of 0..60 m/s at a frequency of 1e3..1e6 Hz. Without wind there is none.
BubbleLayer bubble_layer(double wind_mps, double frequency_hz);

}  // namespace halocline::acoustics
