// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/path_fading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "acoustics/sea/boundary_reflection.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;
using std::numbers::sqrt2;

constexpr double kSoundSpeedMps = 1500;  // for the wave number, as in Eckart's loss

}  // namespace

void validate(const FadingModel& model) {
  require_in_range(model.rice_factor_db, -20, 60, "Rice factor of the medium", "dB");
  require_in_range(model.medium_coherence_s, 0.1, 1e6, "coherence time of the medium", "s");
  require_in_range(model.large_scale_db, 0, 20, "standard deviation of large-scale fading", "dB");
  require_in_range(model.large_scale_time_s, 0.1, 1e6, "correlation time of large-scale fading", "s");
  require_in_range(model.large_scale_still_s, 0, 1e6, "correlation time of large-scale fading at rest", "s");
  require_in_range(model.bottom_roughness_m, 0, 1, "rms roughness of the bottom", "m");
  validate(model.slow);
  require_in_range(model.platform_jitter_m, 0, 5, "vertical movement of the ends", "m");
  require_in_range(model.bottom_slope, 0.01, 1, "rms slope of the bottom");
}

// Solves exp(-(2 pi B T)^2 / 2) = 1/e for B.
double doppler_spread_of(double coherence_s) { return 1 / (sqrt2 * pi * coherence_s); }

double coherence_time_of(double doppler_spread_hz) {
  return doppler_spread_hz > 0 ? 1 / (sqrt2 * pi * doppler_spread_hz)
                               : std::numeric_limits<double>::infinity();
}

// Gamma^2 = (2 k sigma sin(theta))^2, k = 2 pi f / c.
double rayleigh_squares(double rms_height_m, double frequency_hz, double sine_squares) {
  const double one = 2 * (2 * pi * frequency_hz / kSoundSpeedMps) * rms_height_m;
  return one * one * sine_squares;
}

double coherent_share(const FadingModel& model, double surface_height_m, double frequency_hz,
                      double surface_sine_squares, double bottom_sine_squares) {
  return elementary::exp(-rayleigh_squares(surface_height_m, frequency_hz, surface_sine_squares) -
                         rayleigh_squares(model.bottom_roughness_m, frequency_hz, bottom_sine_squares));
}

PathFading path_fading(const FadingModel& model, double wind_mps, double frequency_hz,
                       double surface_sine_squares, double bottom_sine_squares, double kept) {
  const SurfaceBoundary waves{.rms_height_m = rms_wave_height_m(wind_mps),
                              .mean_frequency_radps = wind_mps > 0 ? mean_wave_frequency_radps(wind_mps) : 0};
  return path_fading_below(model, waves, frequency_hz, surface_sine_squares, bottom_sine_squares, kept, 0);
}

PathFading path_fading_below(const FadingModel& model, const SurfaceBoundary& boundary, double frequency_hz,
                             double surface_sine_squares, double bottom_sine_squares, double kept,
                             double speed_mps) {
  if (!model.enabled) return {};
  const double surface = rayleigh_squares(boundary.rms_height_m, frequency_hz, surface_sine_squares);
  const double bottom = rayleigh_squares(model.bottom_roughness_m, frequency_hz, bottom_sine_squares);
  const double log_kept = elementary::log(kept);
  const double steady = elementary::exp(std::min(-surface - bottom - log_kept, 0.0));  // E / kept
  const double rice = to_power_ratio(Decibels{model.rice_factor_db}).value;
  PathFading fading;
  // c = E K / (1 + K), m = E / (1 + K), s = 1 - E, with E / kept in place of E.
  fading.coherent = steady * rice / (1 + rice);
  fading.medium = steady / (1 + rice);
  fading.scattered = -elementary::expm1(std::min(-surface - bottom - log_kept, 0.0));
  const double waves_hz = surface > 0 ? boundary.mean_frequency_radps / (2 * pi) * std::sqrt(surface) : 0;
  double medium_hz = doppler_spread_of(model.medium_coherence_s);
  if (boundary.is_still) {
    const double moving = std::min(speed_mps / kStillSpeedMps, 1.0);
    medium_hz = std::max(medium_hz * moving, doppler_spread_of(kIceCoherenceS));
  }
  fading.doppler_spread_hz = elementary::hypot(waves_hz, medium_hz);
  return fading;
}

}  // namespace halocline::acoustics
