// SPDX-License-Identifier: BSD-3-Clause
#include "core/state_extrapolation.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline {
namespace {

using testing::tolerance;

constexpr double kRounding = 1e-12;

KinematicState turning() {
  KinematicState state;
  state.pose = {{10, 20, 30}, to_quaternion({.yaw = 0.4})};
  state.velocity_ned_mps = {1, -2, 0.5};
  state.angular_velocity_body_radps = {0, 0, 0.1};
  return state;
}

TEST(DeadReckoning, ThePlaceGoesOnStraightAndTheHeadingAtItsRate) {
  const KinematicState later = reckoned(turning(), SimDuration::from_milliseconds(2500));
  EXPECT_LT((later.pose.position_ned_m - Vec3(12.5, 15, 31.25)).norm(), tolerance(kRounding));
  EXPECT_NEAR(to_euler(later.pose.orientation).yaw, 0.65, tolerance(kRounding));
  EXPECT_EQ(later.velocity_ned_mps, turning().velocity_ned_mps);
  EXPECT_EQ(later.angular_velocity_body_radps, turning().angular_velocity_body_radps);
}

TEST(DeadReckoning, BackwardsItUndoesWhatItDidForwards) {
  const SimDuration step = SimDuration::from_milliseconds(700);
  const KinematicState back = reckoned(reckoned(turning(), step), -step);
  EXPECT_LT((back.pose.position_ned_m - turning().pose.position_ned_m).norm(), tolerance(kRounding));
  EXPECT_LT(angle_between(back.pose.orientation, turning().pose.orientation), tolerance(kRounding));
}

TEST(DeadReckoning, AStateAtItsOwnTimeIsItselfToTheLastBit) {
  KinematicState state = turning();
  state.pose.position_ned_m.x() = -0.0;
  const KinematicState same = reckoned(state, SimDuration());
  EXPECT_TRUE(std::signbit(same.pose.position_ned_m.x()));
  EXPECT_EQ(same.pose.orientation.coeffs(), state.pose.orientation.coeffs());
}

TEST(DeadReckoning, TheAngleBetweenAttitudesIsThatOfTheShorterWay) {
  const Quaternion level = Quaternion::Identity();
  for (const double degrees : {0.0, 1e-6, 1.0, 90.0, 180.0, 270.0, 359.0}) {
    const Quaternion turned = rotation_by(to_radians(degrees) * Vec3(0.6, 0, 0.8));
    const double shorter = to_radians(std::min(degrees, 360 - degrees));
    EXPECT_NEAR(angle_between(level, turned), shorter, tolerance(kRounding)) << degrees;
    EXPECT_NEAR(angle_between(turned, level), shorter, tolerance(kRounding)) << degrees;
  }
}

}  // namespace
}  // namespace halocline
