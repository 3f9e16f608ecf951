// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/ray_water.h"

#include <algorithm>
#include <cmath>

#include "acoustics/sea/water_columns.h"
#include "core/check.h"

namespace halocline::acoustics {
namespace {

constexpr double kTallestProbe = 5000.0;  // m; formulas and tables are constant below

constexpr double kMinRounding = 1.0;          // m, least half-height of a rounded kink
constexpr double kFinestRounding = 1.0 / 32;  // spacing of knots at the axis, relative to the half-height
// Relative to the half-height: knots further out would almost coincide with the last.
constexpr double kInside = 0.98;

// The parabola a0 + a1 u + a2 u^2 through the values at u = 0, 1/2 and 1.
LayerAbsorption parabola(double top, double middle, double bottom) {
  return {top, 4 * middle - 3 * top - bottom, 2 * (top + bottom) - 4 * middle};
}

WaterColumns one_column(const std::vector<SpeedRow>& knots) {
  WaterColumns column{{}, {{}}};
  for (const SpeedRow& knot : knots) {
    column.depths_m.push_back(knot.depth_m);
    column.speeds_mps.front().push_back(knot.sound_speed_mps);
  }
  return column;
}

std::vector<SpeedRow> knots_of_column(const WaterColumns& column) {
  std::vector<SpeedRow> knots;
  for (std::size_t i = 0; i < column.depths_m.size(); ++i)
    knots.push_back({column.depths_m[i], column.speeds_mps.front()[i]});
  return knots;
}

// Knots of a smooth profile, sampled to the tolerance.
std::vector<SpeedRow> sampled_knots(const SoundSpeedProfile& profile, double tolerance) {
  std::vector<double> corners = profile.row_depths_m();
  corners.push_back(std::max(kTallestProbe, corners.empty() ? 0.0 : corners.back()));
  corners.insert(corners.begin(), 0);
  const auto speed = [&](std::size_t, double depth) { return profile.sound_speed_mps(depth); };
  return knots_of_column(sampled(corners, 1, speed, tolerance));
}

// Replaces `knot` by several knots on a parabola if it is the axis of a channel and its kink is small enough;
// returns false otherwise. With x = z - z_knot, and g1 and g2 the gradients above and below,
//   c = c_knot + (g1 + g2) x / 2 + (g2 - g1) (x^2 / d + d) / 4  within |x| <= d.
bool round_off(const SpeedRow& above, const SpeedRow& knot, const SpeedRow& below, double tolerance,
               std::vector<SpeedRow>& rounded) {
  const double height_above = knot.depth_m - above.depth_m, height_below = below.depth_m - knot.depth_m;
  const double g1 = (knot.sound_speed_mps - above.sound_speed_mps) / height_above;
  const double g2 = (below.sound_speed_mps - knot.sound_speed_mps) / height_below;
  if (!(g1 < 0 && g2 > 0)) return false;
  const double d = std::min({height_above / 2, height_below / 2, 4 * tolerance / (g2 - g1)});
  if (d < kMinRounding) return false;
  const auto add = [&](double x) {
    const double curve = (g2 - g1) * (x * x / d + d) / 4;
    rounded.push_back({knot.depth_m + x, knot.sound_speed_mps + (g1 + g2) * x / 2 + curve});
  };
  // Knots are close together about the axis, where rays have small amplitudes.
  const double axis = -(g1 + g2) * d / (g2 - g1);
  std::vector<double> offsets;
  for (double y = 0; y < 2 * d; y += std::max(kFinestRounding * d, y / 3)) offsets.push_back(y);
  const double last = rounded.back().depth_m;
  if (knot.depth_m - d > last) add(-d);
  for (std::size_t i = offsets.size(); i-- > 1;) {
    if (axis - offsets[i] > -kInside * d) add(axis - offsets[i]);
  }
  for (const double y : offsets) {
    if (axis + y < kInside * d) add(axis + y);
  }
  add(d);
  return true;
}

std::vector<SpeedRow> table_knots(const SoundSpeedProfile& profile) {
  std::vector<SpeedRow> knots;
  for (const double depth : profile.row_depths_m()) knots.push_back({depth, profile.sound_speed_mps(depth)});
  return knots;
}

}  // namespace

RayWater::RayWater(std::vector<SpeedRow> knots, const AbsorptionAtDepth& absorption_db_per_km) {
  require(!knots.empty(), "a profile needs at least one knot");
  if (knots.front().depth_m > 0) knots.insert(knots.begin(), {0, knots.front().sound_speed_mps});
  if (knots.back().depth_m < kDeepestWater) knots.push_back({kDeepestWater, knots.back().sound_speed_mps});
  for (std::size_t i = 0; i < knots.size(); ++i) {
    require_in_range(knots[i].depth_m, 0, kDeepestWater, "depth of a knot", "m");
    require_in_range(knots[i].sound_speed_mps, 1000, 2000, "sound speed of a knot", "m/s");
    require(i == 0 || knots[i].depth_m > knots[i - 1].depth_m, "the knots of a profile do not go down");
    depth_.push_back(knots[i].depth_m);
    speed_.push_back(knots[i].sound_speed_mps);
  }
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double top = depth_[i], height = depth_[i + 1] - top;
    const auto at = [&](double share) { return absorption_db_per_km(top + share * height) / 1000; };
    gradient_.push_back((speed_[i + 1] - speed_[i]) / height);
    absorption_.push_back(parabola(at(0), at(0.5), at(1)));
  }
}

RayWater RayWater::from_profile(const SoundSpeedProfile& profile,
                                const AbsorptionAtDepth& absorption_db_per_km, double speed_tolerance_mps) {
  const std::vector<SpeedRow> knots = knots_of(profile, speed_tolerance_mps);
  return RayWater(rounded_channels(knots, speed_tolerance_mps), absorption_db_per_km);
}

std::size_t RayWater::layer_at(double depth_m) const {
  const auto below = std::upper_bound(depth_.begin() + 1, depth_.end() - 1, depth_m);
  return static_cast<std::size_t>(below - depth_.begin() - 1);
}

double RayWater::speed_at(double depth_m) const {
  const std::size_t i = layer_at(depth_m);
  return speed_[i] + gradient_[i] * (depth_m - depth_[i]);
}

bool RayWater::is_isovelocity_above(double bottom_depth_m) const {
  for (std::size_t i = 0; i < layers() && depth_[i] < bottom_depth_m; ++i) {
    if (speed_[i + 1] != speed_[i]) return false;
  }
  return true;
}

std::vector<SpeedRow> rounded_channels(const std::vector<SpeedRow>& knots, double tolerance_mps) {
  require_in_range(tolerance_mps, 0, 100, "tolerance of rounding", "m/s");
  std::vector<SpeedRow> rounded;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const bool inner = i > 0 && i + 1 < knots.size();
    if (!inner || !round_off(knots[i - 1], knots[i], knots[i + 1], tolerance_mps, rounded))
      rounded.push_back(knots[i]);
  }
  return rounded;
}

std::vector<SpeedRow> knots_of(const SoundSpeedProfile& profile, double speed_tolerance_mps) {
  require_in_range(speed_tolerance_mps, 1e-6, 10, "speed tolerance of a profile for rays", "m/s");
  return profile.is_table_of_speeds() ? table_knots(profile) : sampled_knots(profile, speed_tolerance_mps);
}

std::vector<SpeedRow> thinned(const std::vector<SpeedRow>& knots, double tolerance_mps) {
  require_in_range(tolerance_mps, 0, 100, "tolerance of thinning", "m/s");
  if (knots.size() < 3) return knots;
  return knots_of_column(thinned(one_column(knots), tolerance_mps));
}

}  // namespace halocline::acoustics
