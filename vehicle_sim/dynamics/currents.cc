// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/currents.h"

#include <algorithm>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kFastest = 10;  // m/s, faster than any ocean current
constexpr std::uint32_t kNorth = 0, kEast = 1;

GaussMarkovProcess process(const RandomCurrent& random, std::uint64_t seed, std::uint32_t component) {
  return {random.deviation_mps,
          random.time_s,
          {.seed = seed, .purpose = purpose_of("current"), .who = component, .which = 0}};
}

void check(const CurrentSettings& s) {
  for (const double v : s.uniform_ned_mps) require_in_range(v, -kFastest, kFastest, "current", "m/s");
  for (std::size_t i = 0; i < s.by_depth.size(); ++i) {
    require_finite(s.by_depth[i].depth_m, "depth of a current");
    require_in_range(s.by_depth[i].north_mps, -kFastest, kFastest, "current", "m/s");
    require_in_range(s.by_depth[i].east_mps, -kFastest, kFastest, "current", "m/s");
    require(i == 0 || s.by_depth[i - 1].depth_m < s.by_depth[i].depth_m, "the depths of a current must rise");
  }
  require_in_range(s.tide.amplitude_mps, 0, kFastest, "tidal amplitude", "m/s");
  require_in_range(s.tide.period_s, 1, 1e9, "tidal period", "s");
  require_finite(s.tide.phase_rad, "tidal phase");
  require_finite(s.tide.toward_rad, "tidal direction");
}

}  // namespace

OceanCurrent::OceanCurrent(const CurrentSettings& settings, std::uint64_t seed)
    : settings_(settings),
      north_(process(settings.random, seed, kNorth)),
      east_(process(settings.random, seed, kEast)) {
  check(settings_);
}

// One tidal constituent toward an azimuth, and a first-order Gauss-Markov process in north and in east
// (Fossen 2021, section 10.3):
//
//   v = A cos(2 pi t / T + phi) (cos(azimuth), sin(azimuth)) + (x_north(t), x_east(t))
Vec3 OceanCurrent::changing_part(SimTime now) {
  const TidalCurrent& tide = settings_.tide;
  const double along = tide.amplitude_mps *
                       elementary::cos(2 * std::numbers::pi * now.seconds() / tide.period_s + tide.phase_rad);
  return {along * elementary::cos(tide.toward_rad) + north_.at(now, north_cursor_),
          along * elementary::sin(tide.toward_rad) + east_.at(now, east_cursor_), 0};
}

// The acceleration is (v(t + h) - v(t)) / h, so that the velocity is exact at both ends of the step.
WaterMotion OceanCurrent::everywhere(SimTime now, SimDuration step) {
  if (!depends_on_time()) return {settings_.uniform_ned_mps, Vec3::Zero()};
  const Vec3 here = changing_part(now), then = changing_part(now + step);
  return {settings_.uniform_ned_mps + here, (then - here) / step.seconds()};
}

// Linear interpolation between the depths of the table, constant beyond them.
Vec3 OceanCurrent::at_depth(double depth_m) const {
  const auto& table = settings_.by_depth;
  if (table.empty()) return Vec3::Zero();
  const auto below =
      std::upper_bound(table.begin(), table.end(), depth_m,
                       [](double depth, const DepthCurrent& row) { return depth < row.depth_m; });
  if (below == table.begin()) return {below->north_mps, below->east_mps, 0};
  const DepthCurrent& a = *(below - 1);
  if (below == table.end()) return {a.north_mps, a.east_mps, 0};
  const double share = (depth_m - a.depth_m) / (below->depth_m - a.depth_m);
  return {a.north_mps + share * (below->north_mps - a.north_mps),
          a.east_mps + share * (below->east_mps - a.east_mps), 0};
}

// The material derivative, by the velocity where the water will be after a step h. The pressure gradient in
// the water gives this acceleration to the water that a hull displaces.
//
//   Du/Dt = du/dt + (u . grad) u = (u(x + h u, t + h) - u(x, t)) / h
WaterMotion motion_of(const ocean::OceanField& field, const Vec3& place, SimTime now, SimDuration step) {
  const Vec3 here = field.current_ned_mps(place, now.seconds());
  const Vec3 then = field.current_ned_mps(place + step.seconds() * here, (now + step).seconds());
  return {here, (then - here) / step.seconds()};
}

}  // namespace halocline::vehicle_sim
