// SPDX-License-Identifier: BSD-3-Clause
// Fading of one path: the shares of its power that are steady, fluctuate with the water, or are scattered by
// rough boundaries.
//
// Model, for a path of mean power P:
//   h(t) = sqrt(P) 10^((X(t) + Y(t))/20) [sqrt(c) e^(j phi) + sqrt(m) g_m(t) + sqrt(s) g_s(t)],  c + m + s =
//   1
// - Surface: the Rayleigh parameter of bounce i is Gamma_i = 2 k sigma_h sin(theta_i), with k the wave number
//   at the centre frequency and sigma_h the rms wave height of Pierson and Moskowitz. The bottom is treated
//   in the same way with its own rms roughness. After all bounces the share E = exp(-sum Gamma_i^2) of the
//   power is coherent (Eckart 1953; Jensen, Kuperman, Porter and Schmidt 2011, section 1.6); the rest is
//   scattered, s = 1 - E. Where scattered sound turns to new angles (FadingModel::turns), paths of several
//   bounces keep the coherent share alone; the rest arrives in the windows of acoustics/scattering.
// - Medium: internal waves and fine structure modulate the share 1 / (1 + K) of the coherent power, with K
//   the Rice factor (Qarabaqi and Stojanovic 2013): c = E K / (1 + K), m = E / (1 + K).
// - Time: g_s and g_m are complex Gaussian with the autocorrelation exp(-(2 pi B tau)^2 / 2). The surface
//   moves at the mean frequency of the waves, omega_m = omega_p / 0.71 with omega_p = 0.877 g / U (Pierson
//   and Moskowitz), which spreads a path by B = omega_m / (2 pi) sqrt(sum Gamma_i^2) Hz rms. B of the medium
//   follows from its coherence time. Scattered sound crosses the same water, so the squares of both spreads
//   add.
//
// Neglected: shadowing by wave crests, swell, motion of the ends over a rough bottom.
#pragma once

#include "acoustics/fading/slow_fading.h"
#include "acoustics/sea/surface/surface_boundary.h"

namespace halocline::acoustics {

// Parameters of the model; defaults are our choices unless a source is named.
struct FadingModel {
  bool enabled = false;            // false: nothing fades, and the powers of paths add
  double rice_factor_db = 10;      // K of the medium, -20..60
  double medium_coherence_s = 20;  // time in which the medium's autocorrelation falls to 1/e, s, 0.1..1e6
  // Standard deviation of X, 0..20 dB (Qarabaqi and Stojanovic 2013: log-normal).
  double large_scale_db = 3;
  double large_scale_time_s = 120;   // correlation time of X, s, 0.1..1e6
  double bottom_roughness_m = 0.02;  // rms height of the bottom, m, 0..1
  SlowFading slow = {};              // changes of the level over hours
  // Correlation time of X between ends at rest, s, 0..1e6; 0: large_scale_time_s. Fast ice sets it.
  double large_scale_still_s = 0;
  // Vertical movement of each end from packet to packet, m rms, 0..5: mean levels are means over it, too.
  double platform_jitter_m = 0;
  // True: scattered sound goes on at new angles (acoustics/scattering), and a path of several bounces keeps
  // its coherent share alone.
  bool turns = false;
  double bottom_slope = 0.2;  // rms slope of the rough bottom's facets in a plane, 0.01..1: rippled sand
  bool operator==(const FadingModel&) const = default;
};

// Throws InvalidArgument, naming the field, its value and the permitted range, unless every field is in
// range.
void validate(const FadingModel& model);

// Shares of the power of one path, and the rate of its fading.
struct PathFading {
  double coherent = 1, medium = 0, scattered = 0;  // their sum is 1
  double doppler_spread_hz = 0;                    // rms, of the scattered share
  bool operator==(const PathFading&) const = default;
};

// Doppler spread of a process whose autocorrelation falls to 1/e within `coherence_s`, Hz rms:
//   B = 1 / (sqrt(2) pi T)
double doppler_spread_of(double coherence_s);
// Coherence time of a Doppler spread, s; infinity for 0.
double coherence_time_of(double doppler_spread_hz);

// Coherence time of what fast ice scatters between ends at rest, s (a choice: hours).
inline constexpr double kIceCoherenceS = 3 * 3600.0;

// Sum of the squared Rayleigh parameters of bounces at a boundary of that rms height:
//   (2 k sigma)^2 sum of sin^2(grazing angle)
double rayleigh_squares(double rms_height_m, double frequency_hz, double sine_squares);

// Coherent share E = exp(-sum Gamma^2) of a path's power after its bounces, 0..1.
double coherent_share(const FadingModel& model, double surface_height_m, double frequency_hz,
                      double surface_sine_squares, double bottom_sine_squares);

// Fading of a path at `frequency_hz` > 0 under `wind_mps` >= 0, given the sums over its bounces of the
// squared sine of the grazing angle (acoustics/rays/eigenray.h). Shares refer to the share `kept` of the
// power that is left, so that E / kept is coherent. A model that is not enabled
// leaves everything coherent.
PathFading path_fading(const FadingModel& model, double wind_mps, double frequency_hz,
                       double surface_sine_squares, double bottom_sine_squares, double kept = 1);

// Fading of a path below a surface that is given as a boundary, by waves or ice. Below fast ice the water
// stands still for ends at rest, and scattered sound changes within kIceCoherenceS; `speed_mps` is the
// greater speed of both ends, and from kStillSpeedMps on the medium's own coherence time holds.
PathFading path_fading_below(const FadingModel& model, const SurfaceBoundary& surface, double frequency_hz,
                             double surface_sine_squares, double bottom_sine_squares, double kept,
                             double speed_mps);

// Speed below which an end counts as partly at rest, m/s (a choice).
inline constexpr double kStillSpeedMps = 0.05;

}  // namespace halocline::acoustics
