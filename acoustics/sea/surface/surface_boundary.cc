// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/surface/surface_boundary.h"

#include <algorithm>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/surface/surface_layers.h"
#include "core/elementary.h"

namespace halocline::acoustics {

// omega_m = omega_p / 0.71, omega_p = 0.877 g / U (Pierson and Moskowitz).
double mean_wave_frequency_radps(double wind_mps) { return 0.877 * 9.81 / wind_mps / 0.71; }

// 0.5 * 4.6e-3 ln(2.1 U^2), U >= 1 (APL-UW TR 9407, part II).
double wave_slope_variance(double wind_mps) {
  const double wind = std::max(wind_mps, 1.0);
  return 0.5 * 4.6e-3 * elementary::log(2.1 * wind * wind);
}

SurfaceBoundary surface_boundary(double wind_mps, const IceCover& ice, double frequency_hz) {
  if (ice.covers()) {
    return {.rms_height_m = ice.roughness_m,
            .slope_variance = ice.slope * ice.slope,
            .is_still = ice.kind == IceKind::kFast,
            .loss_db = ice.loss_db,
            .loss_per_sine_db = ice.loss_per_sine_db};
  }
  return {.rms_height_m = rms_wave_height_m(wind_mps),
          .slope_variance = wave_slope_variance(wind_mps),
          .mean_frequency_radps = wind_mps > 0 ? mean_wave_frequency_radps(wind_mps) : 0,
          .bubbles_db = SurfaceLoss({SurfaceModel::kAplBubbles, wind_mps}, frequency_hz).db_at_sine(1)};
}

double SurfaceBoundary::bounce_db(double sine) const {
  const double bubbles = bubbles_db < kMaxBubbleBounceDb * sine ? bubbles_db / sine
                         : bubbles_db > 0                       ? kMaxBubbleBounceDb
                                                                : 0;
  return bubbles + loss_db + loss_per_sine_db * sine;
}

double SurfaceBoundary::kept_power(double sine) const { return elementary::exp10(-bounce_db(sine) / 10); }

}  // namespace halocline::acoustics
