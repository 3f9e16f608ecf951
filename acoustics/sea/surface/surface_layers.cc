// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/surface/surface_layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/functions.h"
#include "acoustics/sea/boundary_reflection.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kGravity = 9.8;        // m/s^2, the value used in the fit of the wave spectrum
constexpr double kPeakFactor = 0.877;   // omega_p U / g
constexpr double kPeakOverMean = 0.71;  // omega_p / omega_m

}  // namespace

SurfaceWaves surface_waves(double wind_mps) {
  if (!(wind_mps > 0)) return {};
  const double peak = kPeakFactor * kGravity / wind_mps;
  return {rms_wave_height_m(wind_mps), peak / kPeakOverMean, 2 * pi * kGravity / (peak * peak)};
}

double SurfaceWaves::share_under_water(double depth_m) const {
  if (!(rms_height_m > 0)) return depth_m >= 0 ? 1 : 0;
  return normal_probability(depth_m / rms_height_m);
}

double SurfaceWaves::clear_share(double least_depth_m, double length_above_m) const {
  if (!(rms_height_m > 0)) return 1;
  const double under = share_under_water(std::max(least_depth_m, 0.0));
  return elementary::exp((1 + length_above_m / wavelength_m) * elementary::log(under));
}

double SurfaceWaves::heave_mps(double depth_m) const {
  if (!(rms_height_m > 0)) return 0;
  const double decay = mean_frequency_radps * mean_frequency_radps / kGravity;
  return rms_height_m * mean_frequency_radps * elementary::exp(-decay * std::max(depth_m, 0.0));
}

BubbleLayer bubble_layer(double wind_mps, double frequency_hz) {
  constexpr double kJoin = 6;  // m/s
  if (!(wind_mps > 0)) return {};
  const double steady = 0.63e-3 * elementary::pow(std::max(wind_mps, kJoin), 1.57) *
                        elementary::pow(hz_to_khz(frequency_hz), 0.85);
  const double weaker = wind_mps < kJoin ? elementary::exp(1.2 * (wind_mps - kJoin)) : 1;
  return {steady * weaker, 0.4 + 0.115 * std::max(wind_mps - 7.5, 0.0)};
}

double BubbleLayer::db_per_m(double depth_m) const {
  return one_way_db / e_folding_m * elementary::exp(-depth_m / e_folding_m);
}

double BubbleLayer::straight_loss_db(double from_m, double to_m, double length_m) const {
  const double thickness = std::abs(to_m - from_m) / e_folding_m;
  // exp(-z1/L) - exp(-z2/L) = exp(-z1/L) (1 - exp(-h)), with (1 - exp(-h)) / h -> 1 for a level path.
  const double mean = thickness > 1e-8 ? -elementary::expm1(-thickness) / thickness : 1;
  return db_per_m(std::min(from_m, to_m)) * mean * length_m;
}

}  // namespace halocline::acoustics
