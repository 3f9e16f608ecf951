#include "acoustics/link/least_loss.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "acoustics/sea/sound_speed_profile.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

// Depths at which absorption is sampled: every 5 m, further down every fiftieth of the depth.
constexpr double kDepthStep = 5, kDepthGrowth = 1.02;
// Absorption between two samples and sound whose way is bent may be less by this share.
constexpr double kSampled = 0.995;

double next_depth(double depth_m) { return std::max(depth_m + kDepthStep, depth_m * kDepthGrowth); }

}  // namespace

LeastLoss LeastLoss::of_straight_path(const Environment& environment, double frequency_hz,
                                      double deepest_end_m) {
  LeastLoss loss;
  loss.power_law_exponent_ = environment.spreading_exponent;
  const double khz = frequency_hz / 1000;
  double least = std::numeric_limits<double>::infinity();
  for (double depth_m = 0; depth_m < deepest_end_m + kDepthStep; depth_m = next_depth(depth_m)) {
    least = std::min(
        least, absorption_spectrum_at(environment, std::min(depth_m, deepest_end_m)).db_per_km(khz * khz));
  }
  loss.depths_ = {{kSampled * least, 0}};
  return loss;
}

LeastLoss LeastLoss::of_rays(const Environment& environment, double frequency_hz, double deepest_end_m,
                             Decibels gain) {
  LeastLoss loss;
  loss.gain_ = kFocusingGain + gain;
  const double khz = frequency_hz / 1000;
  double least = std::numeric_limits<double>::infinity();
  for (double depth_m = 0; depth_m < kDeepestWater; depth_m = next_depth(depth_m)) {
    least = std::min(least, absorption_spectrum_at(environment, depth_m).db_per_km(khz * khz));
    loss.depths_.push_back({kSampled * least, std::max(2 * (depth_m - deepest_end_m), 0.0)});
  }
  return loss;
}

Decibels LeastLoss::at(double range_m) const {
  const double r = std::max(range_m, 1.0);
  double absorbed_db = std::numeric_limits<double>::infinity();
  for (const Depth& depth : depths_) {
    const double length_km = std::sqrt(r * r + depth.detour_m * depth.detour_m) / 1000;
    absorbed_db = std::min(absorbed_db, depth.absorption_db_per_km * length_km);
  }
  // k 10 log r, or -10 log(pi / (H r) + 2 / r^2).
  const double spreading_db =
      power_law_exponent_ > 0
          ? power_law_exponent_ * 10 * elementary::log10(r)
          : -10 * elementary::log10(std::numbers::pi / (kChannelThickness * r) + 2 / (r * r));
  return Decibels{spreading_db + absorbed_db} - gain_;
}

// Halved by the logarithm of the range, to a millionth.
double LeastLoss::range_of(Decibels loss) const {
  if (at(kGreatestBoundedRange) <= loss) return kGreatestBoundedRange;
  if (at(1) > loss) return 0;
  double low = 1, high = kGreatestBoundedRange;
  while (high > low * (1 + 1e-6)) {
    const double middle = std::sqrt(low * high);
    (at(middle) <= loss ? low : high) = middle;
  }
  return high;
}

}  // namespace halocline::acoustics
