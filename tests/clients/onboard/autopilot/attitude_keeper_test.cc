// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/navigation/attitude_keeper.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

constexpr double kBias = 1e-4;
const double kUnknown = std::numbers::pi / std::sqrt(3.0);

// The compass at time 0, then the gyro alone, ten times a second.
AttitudeKeeper turning(const EulerAngles& first, const Vec3& rates, int samples) {
  AttitudeKeeper keeper(kBias);
  keeper.add({0, first, rates});
  for (int i = 1; i <= samples; ++i) keeper.add({0.1 * i, std::nullopt, rates});
  return keeper;
}

TEST(AttitudeKeeper, TakesTheCompassAsItIs) {
  AttitudeKeeper keeper = turning({}, {0, 0, 0.3}, 50);
  keeper.add({10, EulerAngles{0.1, -0.2, 2.5}, std::nullopt});
  EXPECT_EQ(keeper.attitude().yaw, 2.5);
  EXPECT_EQ(keeper.attitude().roll, 0.1);
  EXPECT_EQ(keeper.heading_deviation_rad(), 0);
}

// A steady turn about the vehicle's own axis is one rotation, whatever the attitude it begins from.
TEST(AttitudeKeeper, SteadyRatesTurnTheAttitudeAboutThatAxis) {
  const EulerAngles first{0.3, -0.2, 1};
  const Vec3 rates(0.05, -0.1, 0.2);
  const AttitudeKeeper keeper = turning(first, rates, 100);
  const Quaternion expected =
      to_quaternion(first) * Quaternion(Eigen::AngleAxisd(10 * rates.norm(), rates.normalized()));
  EXPECT_LT(to_quaternion(keeper.attitude()).angularDistance(expected), tolerance(1e-7));
}

TEST(AttitudeKeeper, DeviationGrowsByTheBiasTimesTheTimeUpToThatOfAnUnknownHeading) {
  EXPECT_NEAR(turning({}, Vec3::Zero(), 100).heading_deviation_rad(), 10 * kBias, tolerance(1e-12));
  AttitudeKeeper keeper(1);
  keeper.add({0, EulerAngles{}, Vec3::Zero()});
  keeper.add({100, std::nullopt, Vec3::Zero()});
  EXPECT_NEAR(keeper.heading_deviation_rad(), kUnknown, tolerance(1e-12));
}

TEST(AttitudeKeeper, WithoutAGyroTheHeadingStaysAndIsUnknownAfterASecond) {
  AttitudeKeeper keeper = turning({}, {0, 0, 0.1}, 10);
  const double before = keeper.attitude().yaw;
  keeper.add({3, std::nullopt, std::nullopt});
  EXPECT_EQ(keeper.attitude().yaw, before);
  EXPECT_NEAR(keeper.heading_deviation_rad(), kUnknown, tolerance(1e-12));
}

TEST(AttitudeKeeper, HeadingIsUnknownBeforeTheFirstCompassReading) {
  EXPECT_NEAR(AttitudeKeeper(kBias).heading_deviation_rad(), kUnknown, tolerance(1e-12));
}

}  // namespace
}  // namespace halocline::clients
