// SPDX-License-Identifier: BSD-3-Clause
// The fast fan tracer against the tracer of eigenrays.
#include "acoustics/rays/fan_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "acoustics/rays/arcs/ray_column.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

RayWater water_of(const std::vector<SpeedRow>& knots) {
  return {knots, [](double) { return 4.0; }};
}

const std::vector<SpeedRow> kDuct = {{0, 1500}, {60, 1480}, {200, 1510}};
// Its last knot is a level bottom's own depth: the ray meets both at once.
const std::vector<SpeedRow> kOneGradient = {{0, 1500}, {5000, 1580}};

struct Sea {
  const char* name;
  std::vector<SpeedRow> knots;
  BottomProfile bottom;
  RayLink link;
};

class FanOverSeas : public ::testing::TestWithParam<Sea> {};

// Both follow the same arcs and add in another order: 1e-7 m and 1e-7 of the slope is what rounding can do
// over some kilometres, 1000 times what was seen (2.5e-11 m, 2e-12).
TEST_P(FanOverSeas, RaysArriveAsByTheExactTracerWithTheSameEvents) {
  const auto& [name, knots, bottom, link] = GetParam();
  const RayWater water = water_of(knots);
  RayOptions options;
  options.min_boundary_factor = 0;  // the two give up faint rays each by its own rule
  const ProfiledSea sea{water, bottom, fluid_bottom(1.9, 1650, 0.8), RaySurface{}, options};
  const ArcTracer exact(sea, link);
  FanTracer quick(exact);
  RayTrace ray;
  int arrived = 0;
  for (int i = -300; i < 300; ++i) {
    const double theta = (i + 0.5) * 1.35 / 300;
    exact.trace(theta, ray);
    const FanRay other = quick.trace(theta);
    ASSERT_EQ(ray.arrived, other.arrived) << theta;
    const auto events = quick.events_of(other);
    ASSERT_TRUE(std::equal(ray.events.begin(), ray.events.end(), events.begin(), events.end())) << theta;
    if (!ray.arrived) continue;
    EXPECT_NEAR(ray.zeta, other.zeta, tolerance(1e-7)) << theta;
    EXPECT_NEAR(ray.zeta_slope, other.zeta_slope, tolerance(1e-7) * (1 + std::abs(ray.zeta_slope))) << theta;
    ++arrived;
  }
  EXPECT_GT(arrived, 150);  // steep ones turn back at the hill
}

INSTANTIATE_TEST_SUITE_P(
    Seas, FanOverSeas,
    ::testing::Values(
        Sea{"summer_flat", kShelf, BottomProfile::flat(120), {25, 60, 3000}},
        Sea{"summer_hill", kShelf, cosine_hill(), {20, 50, 4000}},
        Sea{"duct_hill", kDuct, cosine_hill(), {60, 70, 4500}},
        Sea{"ridge", kDuct, BottomProfile({{0, 200}, {1500, 200}, {2500, 80}, {3500, 200}}), {20, 120, 5000}},
        Sea{"one_gradient", kOneGradient, BottomProfile::flat(5000), {0, 100, 10000}}),
    [](const auto& sea) { return std::string(sea.param.name); });

TEST(FanTracer, ForgetsTheEventsOfRaysTracedSince) {
  const RayWater water = water_of(kShelf);
  const BottomProfile bottom = BottomProfile::flat(120);
  const ProfiledSea sea{water, bottom, fluid_bottom(1.9, 1650, 0.8), RaySurface{}, RayOptions{}};
  const ArcTracer exact(sea, {25, 60, 2000});
  FanTracer quick(exact);
  const FanRay first = quick.trace(0.3);
  const std::size_t kept = quick.kept_events();
  EXPECT_GT(quick.trace(-0.4).events, 0U);
  quick.forget_since(kept);
  EXPECT_EQ(quick.kept_events(), kept);
  EXPECT_EQ(quick.events_of(first).size(), first.events);
}

// d range / d xi of each layer against the difference of ranges: central differences of 1e-6 of xi err by
// 1e-9.
TEST(RayColumn, RangeThroughALayerGrowsByItsSlope) {
  const RayWater water = water_of(kShelf);
  RayColumn column(water, 90, 119), before(water, 90, 119), after(water, 90, 119);
  const double xi = std::cos(0.4) / 1500, step = 1e-6 * xi;
  column.set(xi);
  before.set(xi - step);
  after.set(xi + step);
  for (std::size_t i = 0; i < column.last_knot(); ++i) {
    const double slope = (after.range_through(i) - before.range_through(i)) / (2 * step);
    EXPECT_NEAR(column.range_slope_through(i) / slope, 1, tolerance(1e-7)) << i;
  }
}

// Up and down again: twice all layers above, or through a turn.
TEST(RayColumn, AnExcursionIsTwiceTheWayUp) {
  const RayWater water = water_of(kShelf);
  RayColumn column(water, 72, 119);
  column.set(std::cos(0.4) / 1500);
  double up = 0;
  for (std::size_t i = 0; i < column.excursion_knot(); ++i) up += column.range_through(i);
  EXPECT_FALSE(column.excursion().turns);
  EXPECT_NEAR(column.excursion().range_m, 2 * up, tolerance(1e-9));
  column.set(1 / 1510.0);  // turns between the knots of 1500 and 1512 m/s: 2 sin / (xi |g|) there
  const double sine = column.sine_at(3), g = (1500.0 - 1512.0) / 15;
  up = column.range_through(3) + column.range_through(4) + sine * 1510 / std::abs(g);
  EXPECT_TRUE(column.excursion().turns);
  EXPECT_NEAR(column.excursion().range_m, 2 * up, tolerance(1e-9));
}

}  // namespace
}  // namespace halocline::acoustics
