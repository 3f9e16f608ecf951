// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/state_history.h"

#include <cstdint>

#include <gtest/gtest.h>

#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::for_s;
using testing::state_at;

const PositionRule kRule{.state_lag = for_s(0.05), .state_timeout = for_s(5)};
// Positions of some hundred metres in double precision.
constexpr double kRounding = 1e-9;

TEST(StateHistory, AStateIsCarriedOnByItsVelocity) {
  StateHistory history;
  history.insert(state_at(1, {10, 20, 30}, {1, -2, 0.5}));
  const auto placed = history.at(at_s(3), at_s(3), kRule);
  ASSERT_TRUE(placed);
  EXPECT_LT((placed->position_ned_m - Vec3(12, 16, 31)).norm(), tolerance(kRounding));
  EXPECT_EQ(placed->age, for_s(2));
}

TEST(StateHistory, NobodyIsAnywhereBeforeTheFirstState) {
  StateHistory history;
  history.insert(state_at(1, {0, 0, 0}));
  EXPECT_FALSE(history.at(at_s(0.9), at_s(10), kRule));
  EXPECT_FALSE(StateHistory().at(at_s(1), at_s(1), kRule));
}

TEST(StateHistory, AStateIsUnknownUntilTheLagHasPassed) {
  StateHistory history;
  history.insert(state_at(1, {0, 0, 0}));
  EXPECT_FALSE(history.at(at_s(1.0499), at_s(1.0499), kRule));
  EXPECT_TRUE(history.at(at_s(1.05), at_s(1.05), kRule));
}

TEST(StateHistory, AYoungerStateThanTheLagDoesNotChangeTheAnswer) {
  StateHistory without, with;
  without.insert(state_at(1, {0, 0, 0}, {1, 0, 0}));
  with.insert(state_at(1, {0, 0, 0}, {1, 0, 0}));
  with.insert(state_at(1.96, {999, 0, 0}));
  EXPECT_EQ(without.at(at_s(2), at_s(2), kRule)->position_ned_m,
            with.at(at_s(2), at_s(2), kRule)->position_ned_m);
}

TEST(StateHistory, TheVelocityIsCarriedOnOrInterpolatedAsThePositionIs) {
  StateHistory history;
  history.insert(state_at(1, {0, 0, 0}, {50, 0, 0}));
  history.insert(state_at(2, {10, 0, 0}, {60, 10, 0}));
  EXPECT_EQ(history.at(at_s(1.3), at_s(2.04), kRule)->velocity_ned_mps, Vec3(50, 0, 0));
  const Vec3 between = history.at(at_s(1.3), at_s(2.05), kRule)->velocity_ned_mps;
  EXPECT_LT((between - Vec3(53, 3, 0)).norm(), tolerance(kRounding));
}

TEST(StateHistory, WhatHasPassedIsInterpolatedOnceALaterStateIsKnown) {
  StateHistory history;
  history.insert(state_at(1, {0, 0, 0}, {50, 0, 0}));
  history.insert(state_at(2, {10, 0, 0}, {50, 0, 0}));
  EXPECT_NEAR(history.at(at_s(1.3), at_s(2.05), kRule)->position_ned_m.x(), 3, tolerance(kRounding));
  // Decided an instant earlier the second state is not known yet: extrapolated at 50 m/s.
  EXPECT_NEAR(history.at(at_s(1.3), at_s(2.04), kRule)->position_ned_m.x(), 15, tolerance(kRounding));
}

TEST(StateHistory, AGapLongerThanTheTimeoutIsNotInterpolated) {
  StateHistory history;
  history.insert(state_at(1, {0, 0, 0}, {1, 0, 0}));
  history.insert(state_at(9, {1000, 0, 0}));
  EXPECT_NEAR(history.at(at_s(3), at_s(20), kRule)->position_ned_m.x(), 2, tolerance(kRounding));
}

TEST(StateHistory, APredictionUsesOnlyWhatIsKnownWhenItIsMade) {
  StateHistory history;
  history.insert(state_at(1, {0, 0, 0}, {1, 0, 0}));
  history.insert(state_at(2, {100, 0, 0}, {1, 0, 0}));
  EXPECT_NEAR(history.at(at_s(4), at_s(1.5), kRule)->position_ned_m.x(), 3, tolerance(kRounding));
  EXPECT_NEAR(history.at(at_s(4), at_s(2.5), kRule)->position_ned_m.x(), 102, tolerance(kRounding));
}

TEST(StateHistory, TheOrderOfArrivalDoesNotMatter) {
  StateHistory forward, backward;
  for (int i = 0; i < 50; ++i) forward.insert(state_at(0.1 * i, {1.0 * i * i, 0, 0}));
  for (int i = 49; i >= 0; --i) backward.insert(state_at(0.1 * i, {1.0 * i * i, 0, 0}));
  for (double t = 0; t < 6; t += 0.037) {
    const auto one = forward.at(at_s(t), at_s(t + 0.2), kRule);
    const auto other = backward.at(at_s(t), at_s(t + 0.2), kRule);
    ASSERT_EQ(one.has_value(), other.has_value());
    if (one) {
      EXPECT_EQ(one->position_ned_m, other->position_ned_m);
    }
  }
}

TEST(StateHistory, OfTwoStatesOfOneTimeTheFirstIsKept) {
  StateHistory history;
  EXPECT_TRUE(history.insert(state_at(1, {1, 0, 0})));
  EXPECT_FALSE(history.insert(state_at(1, {2, 0, 0})));
  EXPECT_EQ(history.at(at_s(2), at_s(2), kRule)->position_ned_m.x(), 1);
}

TEST(StateHistory, MemoryIsBounded) {
  StateHistory history;
  for (std::size_t i = 0; i < StateHistory::kMaxStates + 500; ++i) {
    history.insert({SimTime::from_utime(static_cast<std::int64_t>(i)), Vec3::Zero(), Vec3::Zero()});
  }
  EXPECT_EQ(history.size(), StateHistory::kMaxStates);
}

TEST(StateHistory, ForgettingKeepsTheStateThatTheHorizonNeeds) {
  StateHistory history;
  for (int i = 0; i < 10; ++i) history.insert(state_at(i, {1.0 * i, 0, 0}, {1, 0, 0}));
  const auto before = history.at(at_s(5.5), at_s(5.6), kRule);
  history.forget_before(at_s(5.5));
  EXPECT_EQ(history.size(), 5u);
  EXPECT_EQ(history.at(at_s(5.5), at_s(5.6), kRule)->position_ned_m, before->position_ned_m);
}

}  // namespace
}  // namespace halocline::channel_server
