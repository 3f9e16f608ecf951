// SPDX-License-Identifier: BSD-3-Clause
// What every programmed vehicle obeys, and how each behaves under way.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/dynamics/mechanical_energy.h"
#include "vehicle_sim/dynamics/actuator_forces.h"
#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/hull_forces.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_library.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr double kStep = 0.01;

double uniform(std::uint32_t who, std::uint64_t which, double low, double high) {
  return low + (high - low) * uniform_at({.seed = 11, .purpose = 2, .who = who, .which = which});
}

VehicleState random_state(std::uint32_t who) {
  VehicleState s;
  s.orientation = to_quaternion({uniform(who, 0, -3, 3), uniform(who, 1, -1.5, 1.5), uniform(who, 2, -3, 3)});
  for (int k = 0; k < 3; ++k) s.velocity_body[k] = uniform(who, 3 + k, -3, 3);
  for (int k = 3; k < 6; ++k) s.velocity_body[k] = uniform(who, 3 + k, -1, 1);
  return s;
}

VehicleState run(const Model& model, VehicleState state, const ActuatorValues& command, double duration_s,
                 double step_s = kStep, const Water& water = {}) {
  const auto steps = std::lround(duration_s / step_s);
  for (long i = 0; i < steps; ++i) state = rk4_step(model, state, command, water, step_s);
  return state;
}

Model model_named(const std::string& name) { return Model(programmed_model(name).value()); }

// Every actuator of either kind of vehicle at work, in a turn that also pitches.
constexpr ActuatorValues kManoeuvre{0.12, -0.03, 22, {25, 20, 12, 8}};

class EachModel : public ::testing::TestWithParam<std::string> {
 protected:
  Model model_ = model_named(GetParam());
};

// The power of water on a hull without actuators: never positive, whatever the flow.
TEST_P(EachModel, EnergyNeverGrowsWithoutActuatorsAndCurrent) {
  for (std::uint32_t who = 0; who < 1000; ++who) {
    VehicleState state = random_state(who);
    double energy = mechanical_energy_j(model_, state);
    const double allowance = tolerance(1e-9) * std::abs(energy);  // rounding, and the method's error
    for (int i = 0; i < 50; ++i) {
      state = rk4_step(model_, state, {}, {}, kStep);
      const double next = mechanical_energy_j(model_, state);
      ASSERT_LE(next, energy + allowance) << "state " << who << ", step " << i;
      energy = next;
    }
  }
}

// To rounding of terms of 1e2 W.
TEST_P(EachModel, CoriolisForcesDoNoWork) {
  for (std::uint32_t who = 0; who < 1000; ++who) {
    const Vec6 nu = random_state(who).velocity_body;
    EXPECT_NEAR(nu.dot(coriolis_force(model_.mass(), nu).vector()), 0, tolerance(1e-11));
    EXPECT_NEAR(nu.dot(roll_only_coriolis_force(model_.parameters().added_mass, nu).vector()), 0,
                tolerance(1e-11));
  }
}

TEST_P(EachModel, ASteadyCurrentOnlyCarriesThePathAlong) {
  const Vec3 current(0.3, -0.4, 0.1);
  const VehicleState still = run(model_, {}, kManoeuvre, 20);
  VehicleState carried = still;
  carried.velocity_body.head<3>() += still.orientation.inverse() * current;
  const double duration = 120;
  const Vec3 in_still = run(model_, still, kManoeuvre, duration).position_ned_m;
  const Vec3 in_current =
      run(model_, carried, kManoeuvre, duration, kStep, {.current_ned_mps = current}).position_ned_m;
  EXPECT_LT((in_current - in_still - current * duration).norm(), tolerance(1e-9));  // the project's bound
}

// Under way in a manoeuvre where no abs(v) v bends: at steps of 5 to 20 ms the order lies within 3.8 to 4.2.
TEST_P(EachModel, HalvingTheStepDividesTheErrorBySixteen) {
  const VehicleState start = run(model_, {}, kManoeuvre, 30);
  ActuatorValues command = kManoeuvre;
  command.rudder_rad *= 0.8;
  command.propeller_hz *= 1.1;
  for (double& n : command.thruster_hz) n *= 1.05;
  const auto after = [&](double step) { return run(model_, start, command, 4, step).position_ned_m; };
  const Vec3 exact = after(0.000625);
  const double coarse = (after(0.02) - exact).norm(), middle = (after(0.01) - exact).norm(),
               fine = (after(0.005) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / middle), 4, tolerance(0.2));
  EXPECT_NEAR(std::log2(middle / fine), 4, tolerance(0.2));
}

TEST_P(EachModel, AtRestInTrimStaysThere) {
  const VehicleState state = run(model_, {}, {}, 60);
  EXPECT_EQ(state.position_ned_m, Vec3::Zero());
  EXPECT_EQ(state.velocity_body, Vec6::Zero());
}

TEST_P(EachModel, RightsItselfFromAHeel) {
  VehicleState heeled;
  heeled.orientation = to_quaternion({to_radians(60), to_radians(20), 0});
  const EulerAngles settled = to_euler(run(model_, heeled, {}, 120).orientation);
  EXPECT_NEAR(settled.roll, 0, tolerance(to_radians(0.1)));
  EXPECT_NEAR(settled.pitch, 0, tolerance(to_radians(0.1)));
}

TEST_P(EachModel, RunsAsternWithoutBlowingUp) {
  const VehicleState state = run(model_, {}, {0.1, 0.1, -15, {-30, -30, 0, 0}}, 300);
  ASSERT_TRUE(is_finite(state));
  EXPECT_LT(state.linear_velocity_body_mps().norm(), 3);
  EXPECT_LT(state.angular_velocity_body_radps().norm(), 3);
}

TEST_P(EachModel, WhatIsNotANumberStaysWithinItsVehicle) {
  VehicleState lost;
  lost.velocity_body[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_finite(run(model_, lost, kManoeuvre, 0.05)));
  const VehicleState commanded = run(model_, {}, {std::numeric_limits<double>::quiet_NaN(), 0, 20, {}}, 0.05);
  EXPECT_FALSE(is_finite(commanded));
  EXPECT_TRUE(is_finite(run(model_, {}, kManoeuvre, 1)));
}

INSTANTIATE_TEST_SUITE_P(All, EachModel, ::testing::Values("torpedo", "hover", "remus100-pvs"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

constexpr double kFullAhead = 1525.0 / 60;

double turning_radius(const Model& model, double rudder_deg) {
  const VehicleState s = run(model, {}, {to_radians(rudder_deg), 0, kFullAhead}, 150);
  return s.linear_velocity_body_mps().norm() / std::abs(s.velocity_body[5]);
}

// The hull's drag and the propeller are those of remus100-pvs, so the speeds are: to its table's digits.
TEST(Torpedo, StraightSpeedsAreThoseOfThePublishedVehicle) {
  for (const auto& [rpm, speed] : {std::pair{1000, 1.6741}, {1200, 2.0093}, {1525, 2.5536}}) {
    const VehicleState s = run(model_named("torpedo"), {}, {0, 0, rpm / 60.0}, 120);
    EXPECT_NEAR(s.velocity_body[0], speed, tolerance(2e-4)) << rpm;
    EXPECT_NEAR(to_euler(s.orientation).pitch, 0, tolerance(to_radians(0.01)));
  }
}

// Published REMUS 100 models turn in 24.6, 16.1 and 6.7 m at 10 degrees; nothing tighter than two hull
// lengths.
TEST(Torpedo, TurnsSteadilyAndTighterWithMoreRudder) {
  const Model model = model_named("torpedo");
  const double at_5 = turning_radius(model, 5), at_10 = turning_radius(model, 10),
               at_15 = turning_radius(model, 15);
  EXPECT_LT(at_5, 24.6);
  EXPECT_LT(at_10, at_5);
  EXPECT_LT(at_15, at_10);
  EXPECT_GT(at_15, 2 * 1.6);
  EXPECT_NEAR(turning_radius(model, -10), at_10, 0.02 * at_10);  // but for the propeller's torque
}

TEST(Torpedo, LeavesAStraightCourseOnlyWhileTheRudderIsOver) {
  const Model model = model_named("torpedo");
  VehicleState s = run(model, {}, {0, 0, kFullAhead}, 30);
  s = run(model, s, {to_radians(5), 0, kFullAhead}, 5);
  s = run(model, s, {0, 0, kFullAhead}, 20);
  EXPECT_NEAR(s.velocity_body[5], 0, tolerance(1e-3));  // directionally stable ahead
}

TEST(Torpedo, DivesAndClimbsWithItsSternPlanes) {
  const Model model = model_named("torpedo");
  const VehicleState dives = run(model, {}, {0, to_radians(1), kFullAhead}, 40),
                     climbs = run(model, {}, {0, to_radians(-1), kFullAhead}, 40);
  EXPECT_GT(dives.position_ned_m.z(), 10);
  EXPECT_LT(climbs.position_ned_m.z(), -10);
}

// The greatest change of the force from one angle of attack to the next of `parts` round the circle.
double max_change(const Model& model, int parts) {
  VehicleState s;
  s.actuators = {0.1, -0.1, 15, {}};
  Vec6 last = Vec6::Zero();
  double greatest = 0;
  for (int i = 0; i <= parts; ++i) {
    const double alpha = 2 * std::numbers::pi * i / parts;
    s.velocity_body << 2 * std::cos(alpha), 0, 2 * std::sin(alpha), 0, 0, 0;
    const Vec6 now = model.mass() * acceleration(model, s, {});
    if (i > 0) greatest = std::max(greatest, (now - last).cwiseAbs().maxCoeff());
    last = now;
  }
  return greatest;
}

// Where nothing jumps, half the distance makes half the change; the law of remus100-pvs jumps at 180 degrees.
TEST(Torpedo, ForcesAreContinuousThroughEveryAngleOfAttack) {
  const Model torpedo = model_named("torpedo"), published = model_named("remus100-pvs");
  EXPECT_NEAR(max_change(torpedo, 5000) / max_change(torpedo, 10000), 2, tolerance(0.02));
  EXPECT_NEAR(max_change(published, 5000) / max_change(published, 10000), 1, tolerance(0.02));
}

TEST(Remus100Pvs, LiftJumpsInReverseFlowAsPublished) {
  const LiftDrag law = remus100_pvs_parameters(CurrentTreatment::kUpstream).lift_drag;
  Vec6 above = Vec6::Zero(), below = Vec6::Zero();
  above[0] = below[0] = -2;
  above[2] = 1e-9;
  below[2] = -1e-9;
  EXPECT_GT(
      (lift_drag_force(law, 1026, above, 2).vector() - lift_drag_force(law, 1026, below, 2).vector()).norm(),
      100);
}

TEST(BodyLift, IsTheSameForBothDirectionsOfTheFlow) {
  const BodyLift b = programmed_model("torpedo")->body_lift;
  Vec6 ahead = Vec6::Zero();
  ahead.head<3>() << 1.5, 0.4, -0.3;
  Vec6 astern = ahead;
  astern[0] = -1.5;
  const Vec6 a = body_lift_force(b, 1026, ahead).vector(), r = body_lift_force(b, 1026, astern).vector();
  EXPECT_EQ(a[0], -r[0]);
  EXPECT_EQ(a[1], r[1]);
  EXPECT_EQ(a[5], -r[5]);  // it acts behind the middle either way
}

TEST(FinsInLocalFlow, TakeEnergyAtEveryAngleAndDeflection) {
  const FinPair fins = programmed_model("torpedo")->rudder;
  for (std::uint32_t who = 0; who < 1000; ++who) {
    const Vec6 nu = random_state(who).velocity_body;
    // A fin held at an angle is part of the hull: the water does no positive work on it.
    EXPECT_LE(nu.dot(rudder_force(fins, 1026, nu, uniform(who, 20, -0.3, 0.3)).vector()), 1e-12);
    EXPECT_LE(nu.dot(stern_planes_force(fins, 1026, nu, uniform(who, 21, -0.3, 0.3)).vector()), 1e-12);
  }
}

TEST(FinsInLocalFlow, StraightAheadMatchTheLinearLawAtSmallDeflection) {
  FinPair fins = programmed_model("torpedo")->rudder;
  FinPair linear = fins;
  linear.law = FinLaw::kDeflection;
  const Vec6 ahead = 2 * Vec6::Unit(0);
  for (const double delta : {0.01, 0.02}) {
    const Vec6 a = rudder_force(fins, 1026, ahead, delta).vector(),
               b = rudder_force(linear, 1026, ahead, delta).vector();
    EXPECT_NEAR(a[1], b[1], 0.5 * delta * std::abs(b[1]));  // they differ in second order
    EXPECT_NEAR(a[0], b[0], 0.5 * delta * std::abs(b[0]));
  }
}

TEST(Hover, EachPairOfThrustersDrivesItsOwnMotion) {
  const Model model = model_named("hover");
  const auto pushed = [&](const std::array<double, 4>& hz) {
    return run(model, {}, {0, 0, 0, hz}, 2).velocity_body;
  };
  EXPECT_GT(pushed({20, 20, 0, 0})[0], 0.05);
  EXPECT_GT(pushed({20, -20, 0, 0})[5], 0.05);  // port ahead turns to starboard
  EXPECT_GT(pushed({0, 0, 20, 20})[2], 0.05);
  EXPECT_LT(pushed({0, 0, 20, -20})[4], -0.02);  // bow down
}

TEST(Hover, ThrustAtRestIsTheBollardPull) {
  const Thruster t = programmed_model("hover")->thrusters[0];
  EXPECT_NEAR(thruster_force(t, 1026, BodyVelocity(), 0, 60).vector()[0], 51.5, tolerance(1e-9));
  EXPECT_NEAR(thruster_force(t, 1026, BodyVelocity(), 0, -60).vector()[0], -0.78 * 51.5, tolerance(1e-9));
}

TEST(Thruster, PushesAlongItsDirectionAboutItsPlace) {
  Thruster t = programmed_model("hover")->thrusters[0];
  t.position_m = {0.3, -0.2, 0.1};
  t.direction = Vec3(1, 2, -2) / 3;
  t.torque_share = 0;
  const Vec6 force = thruster_force(t, 1026, BodyVelocity(), 0, 30).vector();
  EXPECT_GT(force.head<3>().dot(t.direction), 0);
  EXPECT_LT((force.tail<3>() - t.position_m.cross(Vec3(force.head<3>()))).norm(), tolerance(1e-12));
}

TEST(Thruster, AxialInflowIsThatOfTheWaterAlongTheShaft) {
  const Thruster t = programmed_model("hover")->thrusters[1];
  Vec6 turning = Vec6::Zero();
  turning[5] = 0.5;  // the starboard one moves astern: -r y
  Vec6 backing = Vec6::Zero();
  backing[0] = -0.5 * 0.25;
  EXPECT_NEAR(thruster_force(t, 1026, turning, 0, 30).vector()[0],
              thruster_force(t, 1026, backing, 0, 30).vector()[0], tolerance(1e-12));
  EXPECT_GT(thruster_force(t, 1026, backing, 0, 30).vector()[0],
            thruster_force(t, 1026, BodyVelocity(), 0, 30).vector()[0]);
}

}  // namespace
}  // namespace halocline::vehicle_sim
