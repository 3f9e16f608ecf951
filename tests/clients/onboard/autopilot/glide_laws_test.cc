// SPDX-License-Identifier: BSD-3-Clause
// The laws of a glider, alone and with the glider that they steer.
#include "clients/onboard/autopilot/glide_laws.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "clients/onboard/autopilot/guidance.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_config.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

TEST(GlideLaws, DiveHeavyAndNoseDownAndClimbLightAndNoseUp) {
  const GlideGains glide{.shallow_z_m = 5};
  GlideState state;
  const SetPoints to_40{.z_ned_m = 40};
  const ActuatorCommand dive = glide_command(glide, {}, to_40, {.z_ned_m = 20}, 0.1, state);
  EXPECT_EQ(dive.buoyancy_m3, -glide.volume_m3);
  EXPECT_GT(dive.moving_mass_m, 0);
  EXPECT_EQ(dive.propeller_rpm, 0);
  const ActuatorCommand climb = glide_command(glide, {}, to_40, {.z_ned_m = 40.1}, 0.1, state);
  EXPECT_EQ(climb.buoyancy_m3, glide.volume_m3);
  EXPECT_LT(climb.moving_mass_m, 0);
}

TEST(GlideLaws, TurnAtTheDepthsAndNotBetween) {
  const GlideGains glide{.shallow_z_m = 5};
  GlideState state;
  const auto climbs_at = [&](double z) {
    return glide_command(glide, {}, {.z_ned_m = 40}, {.z_ned_m = z}, 0.1, state).buoyancy_m3 > 0;
  };
  EXPECT_FALSE(climbs_at(20));
  EXPECT_FALSE(climbs_at(39.9));
  EXPECT_TRUE(climbs_at(40));
  EXPECT_TRUE(climbs_at(20));
  EXPECT_TRUE(climbs_at(5.1));
  EXPECT_FALSE(climbs_at(5));
  EXPECT_FALSE(climbs_at(20));
}

TEST(GlideLaws, StoppedIsNeutralAndSurfacingClimbs) {
  GlideState state;
  const ActuatorCommand stopped =
      glide_command({}, {}, {.propel = false, .z_ned_m = 40}, {.z_ned_m = 20}, 0.1, state);
  EXPECT_EQ(stopped.buoyancy_m3, 0);
  EXPECT_EQ(stopped.moving_mass_m, 0);
  const ActuatorCommand surfacing =
      glide_command({}, {}, {.propel = false, .surface = true}, {.z_ned_m = 1}, 0.1, state);
  EXPECT_EQ(surfacing.buoyancy_m3, GlideGains{}.volume_m3);
  EXPECT_LT(surfacing.moving_mass_m, 0);
  EXPECT_EQ(surfacing.rudder_rad, 0);
}

TEST(GlideLaws, TheTrimOfADiveIsMirroredInTheClimb) {
  GlideState dive{.is_climbing = false, .trim_m = 0.02}, climb{.is_climbing = true, .trim_m = 0.02};
  const double pitch = GlideGains{}.pitch_rad;
  EXPECT_EQ(
      glide_command({}, {}, {.z_ned_m = 40}, {.z_ned_m = 20, .pitch_rad = -pitch}, 0.1, dive).moving_mass_m,
      0.02);
  EXPECT_EQ(
      glide_command({}, {}, {.z_ned_m = 40}, {.z_ned_m = 20, .pitch_rad = pitch}, 0.1, climb).moving_mass_m,
      -0.02);
}

// The glider under its laws, heading for a course, from rest at 5 m.
class Glide {
 public:
  Glide() { state.position_ned_m.z() = 5; }

  void run(double seconds, const SetPoints& points) {
    for (double t = 0; t < seconds; t += kPeriodS) {
      const EulerAngles euler = to_euler(state.orientation);
      const Measured measured{
          state.position_ned_m.z(), euler.yaw, euler.pitch, state.velocity_body[4], state.velocity_body[5],
          state.velocity_body[0]};
      const ActuatorCommand c = glide_command({}, {}, points, measured, kPeriodS, laws_);
      for (int i = 0; i < 10; ++i)
        state = rk4_step(
            model_, state,
            {.rudder_rad = c.rudder_rad, .buoyancy_m3 = c.buoyancy_m3, .moving_mass_m = c.moving_mass_m}, {},
            kPeriodS / 10);
      deepest = std::max(deepest, state.position_ned_m.z());
      shallowest = std::min(shallowest, state.position_ned_m.z());
    }
  }

  vehicle_sim::VehicleState state;
  double deepest = 0, shallowest = 1000;

 private:
  static constexpr double kPeriodS = 0.1;
  vehicle_sim::Model model_{vehicle_sim::load_model("glider").parameters};
  GlideState laws_;
};

// Bounds of a requirement: 3 m beyond the depths, what the bladder needs to change sign.
TEST(GlideLaws, SawtoothBetweenTheDepths) {
  Glide glide;
  glide.run(1800, {.course_rad = 0.5, .z_ned_m = 60});
  EXPECT_NEAR(glide.deepest, 60, 3);
  EXPECT_NEAR(glide.shallowest, 5, 3);
  EXPECT_GT(glide.deepest, 60);
}

// The plain mean of a sawtooth is a way of about depth over tan(29 degrees): 0.35 m/s over 1800 s.
TEST(GlideLaws, KeepTheCourseAtTheGlidesSpeed) {
  Glide glide;
  glide.run(1800, {.course_rad = 0.5, .z_ned_m = 60});
  const Vec3& p = glide.state.position_ned_m;
  EXPECT_NEAR(std::atan2(p.y(), p.x()), 0.5, 0.03);
  EXPECT_NEAR(p.head<2>().norm() / 1800, 0.38, 0.05);
}

TEST(GlideLaws, HoldThePitchOfDiveAndClimb) {
  Glide glide;
  glide.run(150, {.z_ned_m = 1000});
  EXPECT_NEAR(to_euler(glide.state.orientation).pitch, -GlideGains{}.pitch_rad, tolerance(to_radians(1)));
  glide.run(100, {.z_ned_m = 0});
  EXPECT_NEAR(to_euler(glide.state.orientation).pitch, GlideGains{}.pitch_rad, tolerance(to_radians(2)));
}

TEST(GlideLaws, TurnToANewCourse) {
  Glide glide;
  glide.run(120, {.course_rad = 0, .z_ned_m = 1000});
  glide.run(300, {.course_rad = 2, .z_ned_m = 1000});
  EXPECT_NEAR(to_euler(glide.state.orientation).yaw, 2, tolerance(0.05));
  EXPECT_LT(std::abs(to_euler(glide.state.orientation).roll), tolerance(to_radians(2)));
}

}  // namespace
}  // namespace halocline::clients
