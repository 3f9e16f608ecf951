// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/localiser/dead_reckoning.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace halocline::clients {
namespace {

using std::numbers::pi;

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

TEST(DeadReckoning, GoesWhereItPointsAtItsSpeed) {
  DeadReckoning track;
  for (int i = 0; i <= 100; ++i) track.take({at(i), 2.0, pi / 3, 0, 10});
  EXPECT_NEAR(track.gone_ne_m(at(100)).x(), 100, 1e-9);
  EXPECT_NEAR(track.gone_ne_m(at(100)).y(), 200 * std::sin(pi / 3), 1e-9);
}

TEST(DeadReckoning, OfAClimbCountsTheHorizontalPartOnly) {
  DeadReckoning track;
  track.take({at(0), 2.0, 0, pi / 3, 10});
  EXPECT_NEAR(track.gone_ne_m(at(10)).x(), 10, 1e-9);
}

// The chord of an arc that the trapezium rule leaves out: v (w dt)^2 / 12 of the way, w = 0.1 rad/s, dt = 0.1
// s.
TEST(DeadReckoning, ClosesACircleToTheErrorOfTheTrapeziumRule) {
  DeadReckoning track;
  const double period_s = 20 * pi;
  constexpr int kSteps = 628;
  for (int i = 0; i <= kSteps; ++i) track.take({at(period_s * i / kSteps), 1.5, 2 * pi * i / kSteps, 0, 0});
  EXPECT_LT(track.gone_ne_m(at(period_s)).norm(), 1e-5);
  const double radius = 15;
  EXPECT_NEAR(track.gone_ne_m(at(period_s / 2)).y(), 2 * radius, 2 * radius * 1e-4 / 12 + 1e-6);
}

TEST(DeadReckoning, LiesBetweenItsMeasurementsAndGoesOnAfterTheLast) {
  DeadReckoning track;
  track.take({at(0), 1.0, 0, 0, 10});
  track.take({at(2), 1.0, 0, 0, 14});
  EXPECT_NEAR(track.gone_ne_m(at(0.5)).x(), 0.5, 1e-12);
  EXPECT_NEAR(track.depth_m(at(0.5)), 11, 1e-12);
  EXPECT_NEAR(track.gone_ne_m(at(5)).x(), 5, 1e-12);
  EXPECT_NEAR(track.depth_m(at(5)), 14, 1e-12);
}

TEST(DeadReckoning, CountsTurnsToEitherSideAndAcrossSouth) {
  DeadReckoning track;
  for (const auto& [seconds, heading_rad] : {std::pair{0.0, 3.0}, {1.0, -3.0}, {2.0, 3.0}})
    track.take({at(seconds), 1.0, heading_rad, 0, 0});
  const double turn = 2 * pi - 6;
  EXPECT_NEAR(track.turned_rad(at(0.5)), 0.5 * turn, 1e-12);
  EXPECT_NEAR(track.turned_rad(at(2)), 2 * turn, 1e-12);
  EXPECT_NEAR(track.turned_rad(at(9)), 2 * turn, 1e-12);
}

TEST(DeadReckoning, LeavesOutWhatIsNoLater) {
  DeadReckoning track;
  track.take({at(0), 1.0, 0, 0, 0});
  track.take({at(1), 1.0, 0, 0, 0});
  track.take({at(1), 50.0, 0, 0, 0});
  track.take({at(0.5), 50.0, 0, 0, 0});
  EXPECT_NEAR(track.gone_ne_m(at(1)).x(), 1, 1e-12);
}

TEST(DeadReckoning, DropsOldHistoryAndKeepsCounting) {
  DeadReckoning track;
  for (int i = 0; i <= 1000; ++i) track.take({at(i), 1.0, 0, 0, 0});
  EXPECT_FALSE(track.covers(at(800)));
  EXPECT_TRUE(track.covers(at(900)));
  EXPECT_NEAR(track.gone_ne_m(at(1000)).x(), 1000, 1e-9);
}

}  // namespace
}  // namespace halocline::clients
