// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/sensors.h"

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

VehicleState moving() {
  VehicleState s;
  s.position_ned_m = {1, 2, 30};
  s.orientation = to_quaternion({0.1, -0.2, 1.5});
  s.velocity_body << 2, 0, 0, 0.01, 0.02, 0.03;
  s.actuators = {0.1, -0.1, 20};
  return s;
}

const Model& remus() {
  static const Model model(remus100_pvs_parameters(CurrentTreatment::kGalilean));
  return model;
}

TEST(Sensors, DepthIsBelowTheSurfaceNotTheDatum) {
  EXPECT_EQ(measure(remus(), moving(), {.sea_surface_z_m = -2}).depth_m, 32);
}

TEST(Sensors, WaterSpeedIsRelativeToTheCurrent) {
  const VehicleState s = moving();
  const Vec3 along = s.orientation * Vec3::UnitX();
  const Water water{.current_ned_mps = 0.5 * along, .sea_surface_z_m = 0};
  EXPECT_NEAR(measure(remus(), s, water).water_speed_mps, 1.5, tolerance(1e-12));
  EXPECT_NEAR(measure_fixed(s, water).water_speed_mps, 1.5, tolerance(1e-12));
}

TEST(Sensors, AttitudeRatesAndActuatorsAreTheStates) {
  const SensorReading r = measure(remus(), moving(), {.sea_surface_z_m = 0});
  EXPECT_NEAR(r.attitude.roll, 0.1, tolerance(1e-12));
  EXPECT_NEAR(r.attitude.pitch, -0.2, tolerance(1e-12));
  EXPECT_NEAR(r.attitude.yaw, 1.5, tolerance(1e-12));
  EXPECT_EQ(r.angular_velocity_body_radps, Vec3(0.01, 0.02, 0.03));
  EXPECT_EQ(r.actuators, moving().actuators);
  EXPECT_EQ(r.altitude.status, AltitudeStatus::kUnavailable);
}

TEST(Sensors, TheAltimeterLooksAlongTheBodysDownAxis) {
  EXPECT_EQ(altimeter_direction({}), Vec3::UnitZ());
  VehicleState bow_up;
  bow_up.orientation = to_quaternion({0, 0.5, 0});
  EXPECT_GT(altimeter_direction(bow_up).x(), 0);  // the keel turns towards the bow's heading
}

}  // namespace
}  // namespace halocline::vehicle_sim
