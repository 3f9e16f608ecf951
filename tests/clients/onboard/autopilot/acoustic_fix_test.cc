// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/navigation/acoustic_fix.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "clients/onboard/autopilot/navigation/navigator.h"
#include "core/frames.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

using std::numbers::pi;
const Vec3 kBeacon(300, -200, 80), kPlace(50, 40, 30);

// What a perfect array measures from `place`.
BeaconMeasurement measured_from(const Vec3& place, const EulerAngles& attitude) {
  const Vec3 towards = to_quaternion(attitude).conjugate() * (kBeacon - place).normalized();
  return {std::atan2(towards.y(), towards.x()), std::asin(-towards.z()), 0.01,
          (kBeacon - place).norm() / 1500};
}

TEST(AcousticFix, APerfectArrayGivesThePlaceAtEveryAttitude) {
  for (const EulerAngles& attitude :
       {EulerAngles{0, 0, 0}, EulerAngles{0.2, -0.4, 2.5}, EulerAngles{-0.3, 0.5, -1}}) {
    const auto fix = place_by_beacon({}, kBeacon, measured_from(kPlace, attitude), attitude, kPlace.z());
    ASSERT_TRUE(fix);
    EXPECT_NEAR(fix->north_m, 50, tolerance(1e-9));
    EXPECT_NEAR(fix->east_m, 40, tolerance(1e-9));
  }
}

TEST(AcousticFix, ItsDeviationIsThatOfAnglesAcrossAndOfTheRangeAlong) {
  const AcousticFixRules rules{
      .sound_speed_mps = 1500, .heading_deviation_rad = 0.02, .range_deviation = 0.005};
  const double horizontal = (kBeacon - kPlace).head<2>().norm(), range = (kBeacon - kPlace).norm();
  const auto fix = place_by_beacon(rules, kBeacon, measured_from(kPlace, {}), {}, kPlace.z());
  EXPECT_NEAR(fix->deviation_m, std::hypot(horizontal * std::hypot(0.01, 0.02), 0.005 * range),
              tolerance(1e-9));
}

TEST(AcousticFix, AHeadingThatIsOffTurnsThePlaceAboutTheBeacon) {
  const auto fix = place_by_beacon({}, kBeacon, measured_from(kPlace, {}), {0, 0, 0.05}, kPlace.z());
  const double horizontal = (kBeacon - kPlace).head<2>().norm();
  EXPECT_NEAR(std::hypot(fix->north_m - 50, fix->east_m - 40), 2 * horizontal * std::sin(0.025),
              tolerance(1e-6));
}

TEST(AcousticFix, ABeaconStraightBelowGivesNoPlace) {
  EXPECT_FALSE(place_by_beacon({}, {50, 40, 80}, {0, -pi / 2, 0.01, 0.03}, {}, 30));
}

// North at 2 m/s, a sample each second for 20 s.
Navigator northwards() {
  Navigator navigator(Vec3::Zero(), {.log_drift_mps = 0.1, .dvl_drift = 0, .start_deviation_m = 10});
  for (int i = 0; i <= 20; ++i) navigator.add({1.0 * i, {0, 0, i % 2 == 0 ? pi : -pi}, 5, -2});
  return navigator;
}

TEST(NavigatorPast, IsLinearBetweenSamplesAndAcrossWholeTurns) {
  const Navigator navigator = northwards();
  EXPECT_NEAR(navigator.at(7.25)->position_ned_m.x(), 14.5, tolerance(1e-9));
  EXPECT_NEAR(std::abs(navigator.at(7.25)->attitude.yaw), pi, tolerance(1e-9));  // not half way round
  EXPECT_FALSE(navigator.at(-1));
  EXPECT_EQ(navigator.at(100)->position_ned_m.x(), navigator.position_ned_m(20).x());
}

TEST(NavigatorPast, AFixOfThePastMovesThePresent) {
  Navigator now = northwards(), then = northwards();
  now.fix(43, 2, 1);
  then.fix(23, 2, 1, 10);  // the same error, of 10 s ago
  EXPECT_NEAR(now.position_ned_m(20).x(), then.position_ned_m(20).x(), tolerance(1e-9));
  EXPECT_NEAR(now.position_ned_m(20).y(), then.position_ned_m(20).y(), tolerance(1e-9));
  EXPECT_NEAR(then.at(10)->position_ned_m.x(), then.position_ned_m(20).x() - 20, tolerance(1e-9));
}

TEST(NavigatorPast, AFixFromBeforeTheHistoryIsIgnored) {
  Navigator navigator = northwards();
  for (int i = 21; i <= 60; ++i) navigator.add({1.0 * i, {}, 5, 2});
  const double before = navigator.position_ned_m(60).x();
  navigator.fix(0, 0, 1, 10);
  EXPECT_EQ(navigator.position_ned_m(60).x(), before);
}

}  // namespace
}  // namespace halocline::clients
