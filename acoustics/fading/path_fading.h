// SPDX-License-Identifier: BSD-3-Clause
// How the power of one path is shared between what stays steady, what the water turns and what rough
// boundaries scatter.
//
// Model, for a path of mean power P:
//   h(t) = sqrt(P) 10^(X(t)/20) [sqrt(c) e^(j phi) + sqrt(m) g_m(t) + sqrt(s) g_s(t)],  c + m + s = 1
// - Surface: Rayleigh parameter of bounce i, Gamma_i = 2 k sigma_h sin(theta_i), k at the centre frequency,
//   sigma_h the rms height of Pierson and Moskowitz. Bottom alike with its own rms roughness. What stays
//   coherent after all bounces is E = exp(-sum Gamma_i^2) of the power (Eckart 1953; Jensen, Kuperman, Porter
//   and Schmidt 2011, section 1.6); the rest is scattered: s = 1 - E. What rough boundaries scatter out of
//   the water is lost beforehand (scattering_loss.h).
// - Medium: of the coherent power 1 / (1 + K) follows internal waves and fine structure, K the Rice factor
//   (Qarabaqi and Stojanovic 2013): c = E K / (1 + K), m = E / (1 + K).
// - Time: g_s and g_m are complex Gaussian with autocorrelation exp(-(2 pi B tau)^2 / 2). The surface moves
//   with the mean frequency of the waves, omega_m = omega_p / 0.71, omega_p = 0.877 g / U (Pierson and
//   Moskowitz), which spreads a path by B = omega_m / (2 pi) sqrt(sum Gamma_i^2) Hz rms. The medium's B is
//   that of its coherence time; what is scattered crosses the same water, so both spreads add in square.
// Left out: shadowing by wave crests, swell, motion of the ends over a rough bottom.
#pragma once

namespace halocline::acoustics {

// Numbers of the model; defaults are our choices unless a source is named.
struct FadingModel {
  bool enabled = false;            // false: nothing fades, powers of paths add
  double rice_factor_db = 10;      // K of the medium, -20..60
  double medium_coherence_s = 20;  // time in which the medium's autocorrelation falls to 1/e, 0.1..1e6
  double large_scale_db = 3;  // standard deviation of X, 0..20 (Qarabaqi and Stojanovic 2013: log-normal)
  double large_scale_time_s = 120;   // correlation time of X, 0.1..1e6
  double bottom_roughness_m = 0.02;  // rms height of the bottom, 0..1
  bool scattering_loss = false;      // acoustics/fading/scattering_loss.h
  bool operator==(const FadingModel&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const FadingModel& model);

// Shares of the power of one path, and the speed of its fading.
struct PathFading {
  double coherent = 1, medium = 0, scattered = 0;  // their sum is 1
  double doppler_spread_hz = 0;                    // rms, of the scattered part
  bool operator==(const PathFading&) const = default;
};

// Spread of a process whose autocorrelation falls to 1/e within `coherence_s`, Hz rms: 1 / (sqrt(2) pi T).
double doppler_spread_of(double coherence_s);
// The inverse; infinity for 0.
double coherence_time_of(double doppler_spread_hz);

// Mean angular frequency of the waves under `wind_mps` > 0, rad/s.
double mean_wave_frequency_radps(double wind_mps);

// Sum of squared Rayleigh parameters, (2 k sigma)^2 sum sin^2(grazing angle), of bounces at a boundary of
// that rms height.
double rayleigh_squares(double rms_height_m, double frequency_hz, double sine_squares);

// Fading of a path whose bounces have these sums of squared sines of the grazing angle
// (acoustics/rays/arrivals.h), at `frequency_hz` > 0 under `wind_mps` >= 0; shares of what is `kept` of its
// power (scattering_loss.h): E / kept is steady. A model that is not enabled leaves everything coherent.
PathFading path_fading(const FadingModel& model, double wind_mps, double frequency_hz,
                       double surface_sine_squares, double bottom_sine_squares, double kept = 1);

}  // namespace halocline::acoustics
