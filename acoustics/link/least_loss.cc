// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/least_loss.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "acoustics/sea/absorption.h"
#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/elementary.h"
#include "ocean/ocean_field.h"

namespace halocline::acoustics {
namespace {

// Depths at which absorption is sampled: steps of 5 m, or of a fiftieth of the depth when that is more.
constexpr double kDepthStep = 5, kDepthGrowth = 1.02;
// Safety factor: the least absorption between two samples, and along a curved path, may be lower by this
// share.
constexpr double kSampled = 0.995;

// Grazing angles over which the bottom's reflection is summed.
constexpr int kAngles = 180;
constexpr double kAngleStep = std::numbers::pi / 2 / kAngles;

// Least absorption at a depth, dB/km: over the temperatures and salinities of a field, at their extremes and
// between them; without a field that of the profile.
double least_absorption(const Environment& environment, double depth_m, double khz) {
  if (!environment.field) return absorption_spectrum_at(environment, depth_m).db_per_km(khz * khz);
  constexpr double kStepDegc = 0.5, kSalinities = 4;
  const ocean::WaterRange range = environment.field.ocean->extremes_at(depth_m);
  const double temperatures = std::ceil((range.greatest_degc - range.least_degc) / kStepDegc) + 1;
  AbsorbingWater water{.temperature_degc = 0,
                       .salinity_psu = 0,
                       .depth_m = depth_m,
                       .pressure_atm = pressure_atm_absolute(depth_m, environment.latitude_rad),
                       .ph = environment.ph};
  double least = std::numeric_limits<double>::infinity();
  for (double i = 0; i <= temperatures; ++i) {
    water.temperature_degc = range.least_degc + i / temperatures * (range.greatest_degc - range.least_degc);
    for (double j = 0; j <= kSalinities; ++j) {
      water.salinity_psu = range.least_psu + j / kSalinities * (range.greatest_psu - range.least_psu);
      least = std::min(least, absorption_spectrum_in(environment, water).db_per_km(khz * khz));
    }
  }
  return least;
}

double next_depth(double depth_m) { return std::max(depth_m + kDepthStep, depth_m * kDepthGrowth); }

// Sum over all ducts of the integral of 2 dtheta / h, theta the angle of a ray at the duct's axis and h the
// distance between its turning points, or a turning point and the surface. The greatest integral of a duct
// that rests on a bottom between the least and the greatest depth is added.
double sum_of_ducts(const Environment& environment, double least_depth_m, double greatest_depth_m) {
  std::vector<double> depths, speeds;
  for (double depth_m = 0;; depth_m = std::min(next_depth(depth_m), greatest_depth_m)) {
    depths.push_back(depth_m);
    speeds.push_back(environment.profile.sound_speed_mps(depth_m));
    if (depth_m >= greatest_depth_m) break;
  }
  // Angle at the axis of the ray that turns at the depth `fast`: cos(theta) = c(axis) / c(fast) by Snell's
  // law.
  const auto angle = [&](std::size_t axis, std::size_t fast) {
    return elementary::acos(speeds[axis] / speeds[fast]);
  };
  double sum = 0, over_bottom = 0;
  for (std::size_t axis = 0; axis + 1 < depths.size(); ++axis) {
    if (axis > 0 && speeds[axis - 1] < speeds[axis]) continue;
    double last = 0;
    std::size_t upper = axis;
    for (std::size_t lower = axis + 1; lower < depths.size() && speeds[lower] > speeds[lower - 1]; ++lower) {
      while (upper > 0 && speeds[upper - 1] < speeds[lower]) --upper;
      const double theta = angle(axis, lower);
      sum += 2 * (theta - std::exchange(last, theta)) / (depths[lower] - depths[upper]);
    }
  }
  for (std::size_t bottom = 1; bottom < depths.size(); ++bottom) {
    if (depths[bottom] < least_depth_m) continue;
    double held = 0, last = 0;
    for (std::size_t upper = bottom; upper > 0 && speeds[upper - 1] > speeds[upper]; --upper) {
      const double theta = angle(bottom, upper - 1);
      held += 2 * (theta - std::exchange(last, theta)) / (depths[bottom] - depths[upper - 1]);
    }
    over_bottom = std::max(over_bottom, held);
  }
  return sum + over_bottom;
}

}  // namespace

LeastLoss LeastLoss::of_straight_path(const Environment& environment, double frequency_hz,
                                      double deepest_end_m) {
  LeastLoss loss;
  loss.power_law_exponent_ = environment.spreading_exponent;
  const double khz = frequency_hz / 1000;
  double least = std::numeric_limits<double>::infinity();
  for (double depth_m = 0; depth_m < deepest_end_m + kDepthStep; depth_m = next_depth(depth_m)) {
    least = std::min(least, least_absorption(environment, std::min(depth_m, deepest_end_m), khz));
  }
  loss.depths_ = {{kSampled * least, 0}};
  return loss;
}

LeastLoss LeastLoss::of_rays(const Environment& environment, double frequency_hz, double deepest_end_m,
                             Decibels gain, const WaterLimits& column) {
  LeastLoss loss;
  loss.gain_ = kFocusingGain + gain;
  const double khz = frequency_hz / 1000;
  double least = std::numeric_limits<double>::infinity();
  for (double depth_m = 0; depth_m < column.greatest_depth_m; depth_m = next_depth(depth_m)) {
    least = std::min(least, least_absorption(environment, depth_m, khz));
    loss.depths_.push_back({kSampled * least, std::max(2 * (depth_m - deepest_end_m), 0.0)});
  }
  if (environment.field) return loss;
  loss.least_depth_m_ = column.least_depth_m;
  if (!(loss.least_depth_m_ > 0)) return loss;
  const double speed = environment.profile.sound_speed_mps(column.least_depth_m);
  for (int i = 0; i < kAngles; ++i) {
    const double angle = (i + 0.5) * kAngleStep;
    const double magnitude = bottom_magnitude_at_sine(column.bottom, elementary::sin(angle), speed);
    loss.reflections_.push_back({elementary::tan(angle), elementary::log(std::max(magnitude, 1e-300))});
  }
  loss.ducts_ = sum_of_ducts(environment, column.least_depth_m, column.greatest_depth_m);
  return loss;
}

Decibels LeastLoss::at(double range_m) const {
  const double r = std::max(range_m, 1.0);
  double absorbed_db = std::numeric_limits<double>::infinity();
  for (const Depth& depth : depths_) {
    const double length_km = std::sqrt(r * r + depth.detour_m * depth.detour_m) / 1000;
    absorbed_db = std::min(absorbed_db, depth.absorption_db_per_km * length_km);
  }
  // TL = k 10 log10 r, or -10 log10 I(r) for rays, plus absorption minus gain.
  const double spreading_db = power_law_exponent_ > 0 ? power_law_exponent_ * 10 * elementary::log10(r)
                                                      : -10 * elementary::log10(greatest_intensity(r));
  return Decibels{spreading_db + absorbed_db} - gain_;
}

// The bound I(r), 1/m^2: pi / (H r) + 2 / r^2, or the sum over the bottom's reflections when the depth is
// known and that is less.
double LeastLoss::greatest_intensity(double r) const {
  const double direct = 2 / (r * r), lossless = std::numbers::pi / (kChannelThickness * r) + direct;
  if (!(least_depth_m_ > 0)) return lossless;
  double sum = 0;
  for (const Reflection& ray : reflections_) {
    const double bounces = std::max(r * ray.tangent / (2 * least_depth_m_) - 1, 0.0);
    sum += kAngleStep * elementary::exp(2 * bounces * ray.log_magnitude);
  }
  return std::min(lossless, direct + 2 * sum / (least_depth_m_ * r) + ducts_ / r);
}

// Bisection in the logarithm of the range, to a relative 1e-6.
double LeastLoss::range_of(Decibels loss) const {
  if (at(kMaxBoundedRange) <= loss) return kMaxBoundedRange;
  if (at(1) > loss) return 0;
  double low = 1, high = kMaxBoundedRange;
  while (high > low * (1 + 1e-6)) {
    const double middle = std::sqrt(low * high);
    (at(middle) <= loss ? low : high) = middle;
  }
  return high;
}

}  // namespace halocline::acoustics
