// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/fine_structure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kFlatness = kBlobHeightM / kBlobLengthM;  // L_v / L_h
constexpr double kLeastSine = 1e-6;  // of a ray that is horizontal: it turns at once, or runs on
constexpr double kRounding = 1e-12;  // of a cosine
const double kRootPi = std::sqrt(std::numbers::pi);

// mu times sqrt(sin^2 theta + (L_v / L_h)^2).
double steepness_free(double speed_variance) {
  return kRootPi * speed_variance / (kBlobSpeedMps * kBlobSpeedMps * kBlobHeightM);
}

// asinh(x) for x >= 0.
double area_sine(double x) { return elementary::log(x + std::sqrt(x * x + 1)); }

}  // namespace

void validate(const FineStructure& structure) {
  require_in_range(structure.speed_mps, 0, 5, "rms sound speed of fine structure", "m/s");
  require_in_range(structure.internal_wave_m, 0, 50, "rms displacement by internal waves", "m");
}

double turning_rate(double speed_variance, double sine) {
  return steepness_free(speed_variance) / std::sqrt(sine * sine + kFlatness * kFlatness);
}

namespace {

// Integral of mu over the range of a ray of Snell's invariant `xi` through part of a layer of constant
// gradient, `range_m` long, between angles of the sines `s1` and `s2`; rad^2.
double turning_through(const FineStructure& structure, double gradient_per_s, double xi, double s1, double s2,
                       double range_m) {
  // With ds = -xi g dr, the integral of dr / sqrt(s^2 + q^2) is (asinh(s1 / q) - asinh(s2 / q)) / (xi g).
  const double free = steepness_free(structure.speed_variance(gradient_per_s));
  const double change = std::abs(s1 - s2);
  if (change < 1e-6) return range_m * turning_rate(structure.speed_variance(gradient_per_s), 0.5 * (s1 + s2));
  const double areas = std::abs(area_sine(std::abs(s1) / kFlatness) - area_sine(std::abs(s2) / kFlatness));
  return free * areas / (xi * std::abs(gradient_per_s));
}

}  // namespace

double cycle_turning_rate(const RayWater& water, const FineStructure& structure, double bottom_m,
                          double depth_m, double xi) {
  const std::vector<double>&depths = water.depths_m(), &speeds = water.speeds_mps();
  const auto sine_at = [xi](double speed) {
    const double cosine = xi * speed;
    return cosine < 1 ? std::sqrt((1 - cosine) * (1 + cosine)) : 0;
  };
  const std::size_t here = water.layer_at(depth_m);
  const double here_mps = water.speed_at(depth_m), sine_here = std::max(sine_at(here_mps), kLeastSine);
  if (xi * here_mps > 1 + kRounding)
    return turning_rate(structure.speed_variance(water.gradients_per_s()[here]), 0);
  double range_m = 0, turned = 0;
  for (const bool down : {false, true}) {
    double z = depth_m, c = here_mps, s = sine_here;
    std::size_t layer = here;
    while (down ? z < bottom_m : z > 0) {
      const double end = down ? std::min(depths[layer + 1], bottom_m) : depths[layer];
      const double g = water.gradients_per_s()[layer], c_end = speeds[layer] + g * (end - depths[layer]);
      const double s_end = sine_at(c_end);
      const bool turns = !(s_end > 0);
      const double range =
          turns ? s / (xi * std::abs(g)) : std::abs(end - z) * xi * (c + c_end) / (s + s_end);
      range_m += range;
      turned += turning_through(structure, g, xi, s, s_end, range);
      if (turns || (!down && layer == 0)) break;
      z = end;
      c = c_end;
      s = s_end;
      layer += down ? 1 : -1;
    }
  }
  return range_m > 0 ? turned / range_m : turning_rate(structure.speed_variance(0), sine_here);
}

}  // namespace halocline::acoustics
