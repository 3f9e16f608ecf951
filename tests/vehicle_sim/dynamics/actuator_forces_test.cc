// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/actuator_forces.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr double kDensity = 1026;
const ModelParameters kRemus = remus100_pvs_parameters(CurrentTreatment::kUpstream);

Vec6 ahead(double speed) { return speed * Vec6::Unit(0); }

TEST(ActuatorForces, PositiveRudderTurnsToStarboardAndSlowsDown) {
  const Vec6 force = rudder_force(kRemus.rudder, kDensity, ahead(2), 0.1).vector();
  // 1/2 1026 4 0.0133 0.5 0.1 N to port at the stern, 0.8 m aft
  const double side = 0.5 * 1026 * 4 * 0.0133 * 0.5 * 0.1;
  EXPECT_NEAR(force[1], -side, tolerance(1e-12));
  EXPECT_NEAR(force[5], 0.8 * side, tolerance(1e-12));
  EXPECT_NEAR(force[0], -0.1 * side, tolerance(1e-12));
}

TEST(ActuatorForces, PositiveSternPlanesPushTheBowDown) {
  const Vec6 force = stern_planes_force(kRemus.stern_planes, kDensity, ahead(2), 0.1).vector();
  EXPECT_LT(force[2], 0);  // stern up
  EXPECT_LT(force[4], 0);  // bow down
  EXPECT_LT(force[0], 0);
}

TEST(ActuatorForces, FinsWithoutFlowOrDeflectionDoNothing) {
  EXPECT_EQ(rudder_force(kRemus.rudder, kDensity, ahead(0), 0.2).vector(), Vec6::Zero());
  EXPECT_EQ(stern_planes_force(kRemus.stern_planes, kDensity, ahead(2), 0).vector().norm(), 0);
}

TEST(ActuatorForces, ThrustFallsWithAdvanceAlongTheOpenWaterLine) {
  const Thruster& p = kRemus.propeller;
  const double n = 20, d4 = std::pow(p.diameter_m, 4);
  EXPECT_NEAR(thruster_force(p, kDensity, BodyVelocity(), 0, n).vector()[0],
              0.9 * kDensity * d4 * 0.4566 * n * n, tolerance(1e-10));
  const double speed_at_jmax = p.advance_max * n * p.diameter_m / p.advance_speed_ratio;
  const Vec6 at_max = thruster_force(p, kDensity, BodyVelocity(), speed_at_jmax, n).vector();
  EXPECT_NEAR(at_max[0], 0.9 * kDensity * d4 * 0.1798 * n * n, tolerance(1e-10));
  EXPECT_NEAR(at_max[3], 0.1 * kDensity * d4 * p.diameter_m * 0.0312 * n * n, tolerance(1e-10));
}

TEST(ActuatorForces, AsternTheInflowDoesNotMatter) {
  EXPECT_EQ(thruster_force(kRemus.propeller, kDensity, BodyVelocity(), 2, -10).vector(),
            thruster_force(kRemus.propeller, kDensity, BodyVelocity(), 0, -10).vector());
  EXPECT_LT(thruster_force(kRemus.propeller, kDensity, BodyVelocity(), 0, -10).vector()[0], 0);
}

TEST(ActuatorForces, CommandsAreHeldToTheLimitsOnBothSides) {
  const ActuatorValues high = limited(kRemus, {9, 9, 99}), low = limited(kRemus, {-9, -9, -99});
  EXPECT_EQ(high, (ActuatorValues{to_radians(15), to_radians(15), 1525.0 / 60}));
  EXPECT_EQ(low, (ActuatorValues{-to_radians(15), -to_radians(15), -1525.0 / 60}));
}

TEST(ActuatorForces, ActuatorsApproachTheirCommandExponentially) {
  const Model model(kRemus);
  VehicleState state;
  for (int i = 0; i < 100; ++i) state = rk4_step(model, state, {0.1, -0.2, 20}, {}, 0.01);
  // RK4 at a tenth of the fin's lag: 1e-7 relative a lag; at a hundredth of the propeller's 1e-11
  EXPECT_NEAR(state.actuators.propeller_hz, 20 * (1 - std::exp(-1)), tolerance(1e-8));
  EXPECT_NEAR(state.actuators.rudder_rad, 0.1 * (1 - std::exp(-10)), tolerance(1e-8));
  EXPECT_NEAR(state.actuators.stern_planes_rad, -0.2 * (1 - std::exp(-10)), tolerance(1e-8));
}

}  // namespace
}  // namespace halocline::vehicle_sim
