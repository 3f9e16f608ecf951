// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/navigation/navigator.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/frames.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

using std::numbers::pi;
const double kNavigatorRounding = tolerance(1e-9);  // of some thousand sums

// Straight and level at 2 m/s towards `heading` for `seconds`.
Navigator after(double seconds, double heading, std::optional<Vec3> over_ground = {}) {
  Navigator navigator({10, 20, 0}, {.log_drift_mps = 0.1, .dvl_drift = 0.01, .start_deviation_m = 1});
  const int steps = static_cast<int>(std::lround(seconds / 0.2));
  for (int i = 0; i <= steps; ++i) navigator.add({0.2 * i, {0, 0, heading}, 30, 2, over_ground});
  return navigator;
}

TEST(Navigator, StraightWayIsSpeedTimesTime) {
  const Vec3 position = after(100, pi / 2).position_ned_m(100);
  EXPECT_NEAR(position.x(), 10, kNavigatorRounding);
  EXPECT_NEAR(position.y(), 20 + 200, kNavigatorRounding);
  EXPECT_EQ(position.z(), 30);
}

TEST(Navigator, PitchShortensTheWay) {
  Navigator navigator(Vec3::Zero(), {});
  for (int i = 0; i <= 100; ++i) navigator.add({0.1 * i, {0, -pi / 3, 0}, 0, 2});
  EXPECT_NEAR(navigator.position_ned_m(10).x(), 10, kNavigatorRounding);  // 20 m along a slope of 60 degrees
}

TEST(Navigator, CircleClosesToTheSecondOrderOfTheStep) {
  // A circle of 2 m/s in 60 s: the trapezium of a chord is exact for evenly spaced samples of a full period.
  Navigator navigator(Vec3::Zero(), {});
  for (int i = 0; i <= 600; ++i) navigator.add({0.1 * i, {0, 0, 2 * pi * i / 600}, 0, 2});
  EXPECT_NEAR(navigator.position_ned_m(60).norm(), 0, kNavigatorRounding);
}

TEST(Navigator, IsOffByTheCurrentTimesTheTimeWithoutADopplerLog) {
  const Vec3 current(0.05, -0.03, 0);
  const Vec3 truth = Vec3(10, 20, 30) + 100 * (Vec3(2, 0, 0) + current);
  const Vec3 off = after(100, 0).position_ned_m(100) - truth;
  EXPECT_NEAR((off + 100 * current).norm(), 0, kNavigatorRounding);
}

TEST(Navigator, DopplerLogSeesTheCurrent) {
  const Vec3 over_ground(2.05, -0.03, 0);
  const Vec3 off = after(100, 0, over_ground).position_ned_m(100) - (Vec3(10, 20, 30) + 100 * over_ground);
  EXPECT_NEAR(off.norm(), 0, kNavigatorRounding);
}

TEST(Navigator, DeviationGrowsWithTimeThroughTheWaterAndWithWayOverGround) {
  EXPECT_NEAR(after(100, 0).deviation_m(), 1 + 0.1 * 100, kNavigatorRounding);
  EXPECT_NEAR(after(100, 0, Vec3(2, 0, 0)).deviation_m(), 1 + 0.01 * 200, kNavigatorRounding);
}

TEST(Navigator, GoodFixRemovesTheDrift) {
  Navigator navigator = after(1000, 0);  // deviation 101 m
  navigator.fix(500, 40, 1);
  const Vec3 position = navigator.position_ned_m(1000);
  // What is left: P / (P + R) falls short of 1 by 1 in 10202 of 1510 m.
  EXPECT_NEAR(position.x(), 500, 0.2);
  EXPECT_NEAR(position.y(), 40, 0.2);
  EXPECT_LT(navigator.deviation_m(), 1);
}

TEST(Navigator, FixAsGoodAsTheReckoningMeetsItHalfway) {
  Navigator navigator = after(100, 0);  // at (210, 20), deviation 11 m
  navigator.fix(200, 40, 11);
  EXPECT_NEAR(navigator.position_ned_m(100).x(), 205, kNavigatorRounding);
  EXPECT_NEAR(navigator.position_ned_m(100).y(), 30, kNavigatorRounding);
  EXPECT_NEAR(navigator.deviation_m(), 11 / std::sqrt(2.0), kNavigatorRounding);
}

TEST(Navigator, ReplacedPlaceIsTakenAsItIs) {
  Navigator navigator = after(1000, 0);
  navigator.replace(500, 40, 3);
  EXPECT_EQ(navigator.position_ned_m(1000), Vec3(500, 40, 30));
  EXPECT_EQ(navigator.deviation_m(), 3);
}

TEST(Navigator, SampleOfThePastIsIgnored) {
  Navigator navigator = after(10, 0);
  const Vec3 before = navigator.position_ned_m(10);
  navigator.add({5, {0, 0, 1}, 99, 9});
  EXPECT_EQ(navigator.position_ned_m(10), before);
}

TEST(Navigator, BetweenSamplesItGoesOnAtTheLastVelocity) {
  EXPECT_NEAR(after(10, 0).position_ned_m(10.5).x(), 10 + 20 + 1, kNavigatorRounding);
}

TEST(Navigator, FixWithoutADeviationIsRefused) {
  Navigator navigator = after(10, 0);
  EXPECT_THROW(navigator.fix(0, 0, 0), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
