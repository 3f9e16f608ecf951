// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/surface_waves.h"

#include <algorithm>
#include <numbers>

#include "acoustics/math/functions.h"
#include "acoustics/sea/boundary_reflection.h"
#include "core/elementary.h"

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

}  // namespace halocline::acoustics
