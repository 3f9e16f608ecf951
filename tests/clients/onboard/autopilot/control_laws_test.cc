// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/control_laws.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

using std::numbers::pi;
const double kControlLawsRounding = tolerance(1e-12);

struct Case {
  Gains gains;
  SetPoints points{.speed_mps = 1.5};
  Measured measured{.speed_mps = 1.5};
  Integrals integrals;
  ActuatorCommand after(double dt_s = 0.1) { return command(gains, points, measured, dt_s, integrals); }
};

TEST(ControlLaws, NothingToCorrectGivesAmidshipsAndFeedForward) {
  const ActuatorCommand c = Case{}.after();
  EXPECT_EQ(c.rudder_rad, 0);
  EXPECT_EQ(c.stern_plane_rad, 0);
  EXPECT_NEAR(c.propeller_rpm, 597.3 * 1.5, kControlLawsRounding * 1e3);
}

TEST(ControlLaws, CourseToStarboardGivesPositiveRudderInProportion) {
  Case c;
  c.points.course_rad = 0.1;
  EXPECT_NEAR(c.after().rudder_rad, 0.1 * c.gains.heading_p, kControlLawsRounding);
}

TEST(ControlLaws, TurnGoesTheShortWayAcrossSouth) {
  Case c;
  c.measured.heading_rad = pi - 0.05;
  c.points.course_rad = -pi + 0.05;
  EXPECT_NEAR(c.after().rudder_rad, 0.1 * c.gains.heading_p, kControlLawsRounding);
}

TEST(ControlLaws, YawRateIsDamped) {
  Case c;
  c.measured.yaw_rate_radps = 0.2;
  EXPECT_NEAR(c.after().rudder_rad, -0.2 * c.gains.heading_d_s, kControlLawsRounding);
}

TEST(ControlLaws, TooShallowPushesTheNoseDown) {
  Case c;
  c.points.z_ned_m = 10;
  EXPECT_GT(c.after().stern_plane_rad, 0);
}

TEST(ControlLaws, TooDeepPullsTheNoseUp) {
  Case c;
  c.measured.z_ned_m = 10;
  EXPECT_LT(c.after().stern_plane_rad, 0);
}

TEST(ControlLaws, PitchAtItsSetLimitNeedsNoStern) {
  Case c;
  c.points.z_ned_m = 1000;  // far below: the set pitch is the maximum, down
  c.measured.pitch_rad = -c.gains.max_pitch_rad;
  EXPECT_NEAR(c.after().stern_plane_rad, 0, kControlLawsRounding);
}

TEST(ControlLaws, FinsAndPropellerStayWithinTheirLimits) {
  Case c;
  c.points = {.course_rad = 3, .z_ned_m = 1000, .speed_mps = 20};
  const ActuatorCommand out = c.after();
  EXPECT_EQ(out.rudder_rad, c.gains.max_fin_rad);
  EXPECT_EQ(out.stern_plane_rad, c.gains.max_fin_rad);
  EXPECT_EQ(out.propeller_rpm, c.gains.max_rpm);
}

TEST(ControlLaws, PropellerNeverTurnsAstern) {
  Case c;
  c.measured.speed_mps = 50;
  EXPECT_EQ(c.after().propeller_rpm, 0);
}

TEST(ControlLaws, IntegralStandsStillWhileTheOutputIsLimited) {
  Case c;
  c.points.speed_mps = 20;
  c.points.z_ned_m = 1000;
  for (int i = 0; i < 1000; ++i) c.after();
  EXPECT_EQ(c.integrals.speed_rpm, 0);
  EXPECT_EQ(c.integrals.pitch_rad, 0);
}

TEST(ControlLaws, DepthIntegralLevelsAVehicleThatIsNotTrimmed) {
  Case c;
  c.gains.depth_i_rad_per_m_s = 0.01;
  c.measured.z_ned_m = 0.5;
  for (int i = 0; i < 10; ++i) c.after(0.1);
  EXPECT_NEAR(c.integrals.pitch_rad, 0.01 * 0.5 * 1.0, kControlLawsRounding);
}

TEST(ControlLaws, IntegralGrowsWithALastingError) {
  Case c;
  c.measured.speed_mps = 1.4;
  for (int i = 0; i < 10; ++i) c.after(0.1);
  EXPECT_NEAR(c.integrals.speed_rpm, c.gains.speed_i_rpm_per_m * 0.1 * 1.0, kControlLawsRounding * 10);
}

TEST(ControlLaws, StoppedMeansAllAtZero) {
  Case c;
  c.points = {.propel = false, .course_rad = 1, .z_ned_m = 100, .speed_mps = 0};
  const ActuatorCommand out = c.after();
  EXPECT_EQ(out.propeller_rpm, 0);
  EXPECT_EQ(out.rudder_rad, 0);
  EXPECT_EQ(out.stern_plane_rad, 0);
}

}  // namespace
}  // namespace halocline::clients
