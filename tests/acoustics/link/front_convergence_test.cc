// SPDX-License-Identifier: BSD-3-Clause
// Eigenrays through a smooth front that was sampled on the grid of an ocean field, against rays integrated
// through the front itself.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/field_section.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed.h"
#include "core/frames.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "tests/acoustics/rays/runge_kutta_ray.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

constexpr double kFrequency = 25'000, kBottom = 200;
constexpr double kFront = 3000, kWidth = 800;  // along north
// Levels of paths near a caustic are not compared: ray theory itself does not give them to 0.1 dB. The two
// rays of a fold, 4/3 x^(3/2) apart in phase, have the amplitude of Airy's function but for 5 / (48 x^(3/2))
// (Abramowitz and Stegun 10.4.60), 0.1 dB at 12 rad.
constexpr double kMinSeparationRad = 12;
constexpr double kMeridionalRadius = 6'335'439.327;  // WGS 84, at the equator
const FluidBottom kSand = fluid_bottom(1.9, 1650, 0.8);

SpeedThere front(double north_m, double depth_m) { return front_speed(kFront, kWidth, north_m, depth_m); }

// The temperature at which water of 35 psu has the front's sound speed, by halving.
double temperature_degc(const Environment& sea, double north_m, double depth_m) {
  const double speed = front(north_m, depth_m).c;
  double low = -5, high = 30;
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (sound_speed_mps(sea.profile.model(), middle, 35, depth_m, sea.latitude_rad) < speed ? low : high) =
        middle;
  }
  return low;
}

// The front on rows `step_m` apart and levels `level_m` apart; it is the same along the east.
Environment sampled_front(double step_m, double level_m) {
  Environment sea;
  ocean::OceanGrid grid{{0}, {}, {}, {-0.002, 0.002}};
  for (double depth = 0; depth <= kBottom + 20; depth += level_m) grid.depths_m.push_back(depth);
  for (double north = -1000; north <= 8000; north += step_m)
    grid.latitudes_rad.push_back(north / kMeridionalRadius);
  ocean::OceanValues values;
  for (const double depth : grid.depths_m) {
    for (const double latitude : grid.latitudes_rad) {
      const auto value = static_cast<float>(temperature_degc(sea, latitude * kMeridionalRadius, depth));
      values.temperature_degc.insert(values.temperature_degc.end(), 2, value);
      values.salinity_psu.insert(values.salinity_psu.end(), 2, 35.0F);
    }
  }
  const ocean::GeodeticOrigin origin{0, 0};
  sea.field = {std::make_shared<const ocean::OceanField>(std::move(grid), std::move(values), origin), 300,
               600};
  sea.profile = environment_at(sea, 0, 0).profile;
  return sea;
}

struct Errors {
  std::vector<double> delays_s, decibels;
  std::size_t not_compared = 0;
};

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Of the paths of one link within 30 dB of the strongest. Where two come to one of the front's own, the one
// launched nearest to it counts.
void compare_link(const Environment& sea, const Vec3& from, const Vec3& to, const RayLink& link,
                  Errors& errors) {
  const LinkWater along = water_between(sea, from, to, kBottom, kFrequency, 0);
  RaySea rays{along.water, BottomProfile::flat(kBottom), kSand, {}, {}};
  rays.section = along.section;
  rays.options.max_bounces = 4;
  rays.options.airy_folds = false;
  rays.options.diffuse_below_db = 0;
  const double northward = (to.x() - from.x()) / link.range_m;
  const PiecewiseWater smooth{[](double, double) { return 0; },
                              [&](int, double r, double z) -> SpeedThere {
                                const SpeedThere there = front(from.x() + northward * r, z);
                                return {there.c, northward * there.along, there.down};
                              }};
  const RungeKuttaTracer tracer(
      smooth, {kBottom, 0}, [](double sine, double c) { return bottom_magnitude_at_sine(kSand, sine, c); },
      5);
  const auto found = eigenrays(rays, link).paths;
  double strongest = 0;
  for (const Eigenray& path : found) strongest = std::max(strongest, path.amplitude);
  std::map<std::tuple<int, int, int>, std::pair<double, Compared>> nearest;  // by bounces and microradians
  for (const Eigenray& path : found) {
    if (path.amplitude < 0.03 * strongest) continue;
    const auto one = compare(tracer, link, path);
    if (!one) {
      ++errors.not_compared;
      continue;
    }
    const double off = std::abs(one->launch_angle_rad - path.launch_angle_rad);
    const std::tuple key(path.surface_bounces, path.bottom_bounces,
                         static_cast<int>(std::lround(one->launch_angle_rad * 1e6)));
    const auto [entry, is_new] = nearest.try_emplace(key, off, *one);
    if (!is_new && off < entry->second.first) entry->second = {off, *one};
  }
  for (const auto& [key, best] : nearest) {
    errors.delays_s.push_back(best.second.delay_s);
    const double apart_rad = 2 * std::numbers::pi * kFrequency * best.second.fold_delay_s;
    if (apart_rad > kMinSeparationRad) errors.decibels.push_back(best.second.decibels);
  }
}

Errors errors_of(double step_m, double level_m, int links) {
  const Environment sea = sampled_front(step_m, level_m);
  std::mt19937 draw(21);
  std::uniform_real_distribution<double> share(0, 1);
  Errors errors;
  for (int k = 0; k < links; ++k) {
    const double range = 1000 + 4000 * share(draw), bearing = 1.4 * (share(draw) - 0.5);
    const Vec3 from{kFront - range * share(draw), 0, 0};
    const Vec3 to = from + range * Vec3(std::cos(bearing), std::sin(bearing), 0);
    const RayLink link{5 + 170 * share(draw), 5 + 170 * share(draw), range};
    compare_link(sea, from, to, link, errors);
  }
  return errors;
}

// Half the step and half the level leave a fifteenth of the delay's error. Levels converge, too.
TEST(SampledFront, EigenraysConvergeToThoseOfTheFrontItself) {
  constexpr int kLinks = 100;
  std::vector<double> medians_s;
  Errors errors;
  for (const double finer : {1, 2, 4}) {
    errors = errors_of(400 / finer, 8 / finer, kLinks);
    ASSERT_GT(errors.delays_s.size(), 500U);
    EXPECT_LT(errors.not_compared, errors.delays_s.size() / 100);
    medians_s.push_back(quantile(errors.delays_s, 0.5));
  }
  for (std::size_t i = 1; i < medians_s.size(); ++i) EXPECT_GT(medians_s[i - 1] / medians_s[i], 8);
  EXPECT_LT(quantile(errors.delays_s, 1), tolerance(1e-6));
  EXPECT_LT(quantile(errors.decibels, 0.5), tolerance(0.01));
  EXPECT_LT(quantile(errors.decibels, 1), tolerance(0.1));
  EXPECT_GT(errors.decibels.size(), 0.95 * static_cast<double>(errors.delays_s.size()));
}

}  // namespace
}  // namespace halocline::acoustics
