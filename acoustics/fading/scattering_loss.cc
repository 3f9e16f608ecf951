// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/scattering_loss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kSoundSpeedMps = 1500;

// Integral, over slopes a above `from`, of (tangent + a) times the normal density of standard deviation
// `slope`.
double facing(double tangent, double slope, double from) {
  const double x = from / slope;
  return tangent * elementary::erfc(x / std::numbers::sqrt2) / 2 +
         slope * elementary::exp(-x * x / 2) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

// Share of the power that remains after `count` bounces whose Gamma^2 sum to `rayleigh_squares`, each losing
// `share` of what it scatters:
//   (1 - share (1 - exp(-Gamma^2 / count)))^count
double kept_of_bounces(int count, double rayleigh_squares, double share) {
  return count == 0 ? 1 : elementary::pow(1 + share * elementary::expm1(-rayleigh_squares / count), count);
}

// The remaining share at the surface, with the mean grazing angle of the surface bounces.
double kept_at_surface(double wind_mps, double frequency_hz, double trapped_share,
                       const RoughBounces& bounces) {
  const int count = std::min(bounces.surface_count, bounces.bottom_count);
  if (count == 0 || !(wind_mps > 0)) return 1;
  const double mean_square = bounces.surface_sine_squares / bounces.surface_count;
  if (!(mean_square < trapped_share)) return 1;
  // The share that a surface bounce loses of what it scatters: f (1 - sin^2(theta) / q).
  const double lost =
      steepened_share(wind_mps, std::sqrt(mean_square), trapped_share) * (1 - mean_square / trapped_share);
  return kept_of_bounces(
      count, rayleigh_squares(rms_wave_height_m(wind_mps), frequency_hz, count * mean_square), lost);
}

}  // namespace

double trapped_share(const FluidBottom& bottom) {
  // q = 1 - (c_water / c_bottom)^2.
  const double ratio =
      bottom.sound_speed_ratio > 0 ? bottom.sound_speed_ratio : bottom.sound_speed_mps / kSoundSpeedMps;
  return ratio > 1 ? 1 - 1 / (ratio * ratio) : 0;
}

// f = integral of (tan(theta) + a) N(a) over slopes a that turn sound beyond the critical angle, divided by
// the integral over all slopes that face the sound, a > -tan(theta).
double steepened_share(double wind_mps, double sine, double trapped_share) {
  const double slope = std::sqrt((0.003 + 5.12e-3 * wind_mps) / 2);
  const double grazing = std::clamp(sine, 1e-9, 1 - 1e-9), cosine = std::sqrt(1 - grazing * grazing);
  // Facets steeper than tan((critical - grazing) / 2) turn the sound beyond the critical angle; the tangent
  // of the half difference follows from sines and cosines.
  const double tangent = grazing / cosine,
               steep = (std::sqrt(trapped_share) - grazing) / (std::sqrt(1 - trapped_share) + cosine);
  return facing(tangent, slope, std::max(steep, -tangent)) / facing(tangent, slope, -tangent);
}

double kept_share(const FadingModel& model, double wind_mps, double frequency_hz, double trapped_share,
                  const RoughBounces& bounces) {
  if (!model.enabled || !model.scattering_loss) return 1;
  const double bottom = rayleigh_squares(model.bottom_roughness_m, frequency_hz, bounces.bottom_sine_squares);
  return kept_of_bounces(bounces.bottom_count, bottom, 1 - trapped_share) *
         kept_at_surface(wind_mps, frequency_hz, trapped_share, bounces);
}

}  // namespace halocline::acoustics
