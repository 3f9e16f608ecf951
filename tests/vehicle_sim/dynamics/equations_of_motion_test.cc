// SPDX-License-Identifier: BSD-3-Clause
// What any correct solution of the equations obeys: order of the method, invariances, energy, and key
// figures.
#include "vehicle_sim/dynamics/equations_of_motion.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/dynamics/mechanical_energy.h"
#include "tests/vehicle_sim/dynamics/reference_motion.h"
#include "vehicle_sim/dynamics/hull_forces.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;
using testing::current_toward;

constexpr double kStep = 0.01;
constexpr ActuatorValues kAhead{0, 0, 1525.0 / 60};

Model published() { return Model(remus100_pvs_parameters(CurrentTreatment::kUpstream)); }
Model galilean() { return Model(remus100_pvs_parameters(CurrentTreatment::kGalilean)); }

double uniform(std::uint32_t who, std::uint64_t which, double low, double high) {
  return low + (high - low) * uniform_at({.seed = 7, .purpose = 1, .who = who, .which = which});
}

VehicleState random_state(std::uint32_t who) {
  VehicleState s;
  s.orientation = to_quaternion({uniform(who, 0, -3, 3), uniform(who, 1, -1.5, 1.5), uniform(who, 2, -3, 3)});
  for (int k = 0; k < 3; ++k) s.velocity_body[k] = uniform(who, 3 + k, -3, 3);
  for (int k = 3; k < 6; ++k) s.velocity_body[k] = uniform(who, 3 + k, -1, 1);
  return s;
}

VehicleState run(const Model& model, VehicleState state, const ActuatorValues& command, const Water& water,
                 double duration_s, double step_s) {
  const auto steps = std::lround(duration_s / step_s);
  for (long i = 0; i < steps; ++i) state = rk4_step(model, state, command, water, step_s);
  return state;
}

// Under way in a turn that also pitches and rolls: every term acts, none at a kink.
VehicleState turning(const Model& model) {
  return run(model, {}, {to_radians(8), to_radians(-3), 20}, {}, 20, kStep);
}

TEST(EquationsOfMotion, HalvingTheStepDividesTheErrorBySixteen) {
  const Model model = galilean();
  const ActuatorValues command{to_radians(-6), to_radians(2), 25};
  const Water water{.current_ned_mps = {0.2, -0.3, 0.05}};
  const VehicleState start = turning(model);
  const auto after = [&](double step) { return run(model, start, command, water, 4, step).position_ned_m; };
  const Vec3 exact = after(0.00125);
  const double coarse = (after(0.04) - exact).norm(), middle = (after(0.02) - exact).norm(),
               fine = (after(0.01) - exact).norm();
  // The order tends to 4 as the step falls; at these steps the next term of the error still shows.
  EXPECT_NEAR(std::log2(coarse / middle), 4, tolerance(0.2));
  EXPECT_NEAR(std::log2(middle / fine), 4, tolerance(0.2));
}

TEST(EquationsOfMotion, ASteadyCurrentOnlyCarriesThePathAlong) {
  const Model model = galilean();
  const Vec3 current(0.3, -0.4, 0.1);
  const VehicleState still = turning(model);
  VehicleState carried = still;
  carried.velocity_body.head<3>() += still.orientation.inverse() * current;
  const ActuatorValues command{to_radians(10), to_radians(-5), 25};
  const double duration = 120;
  const Vec3 in_still = run(model, still, command, {}, duration, kStep).position_ned_m;
  const Vec3 in_current =
      run(model, carried, command, {.current_ned_mps = current}, duration, kStep).position_ned_m;
  // Rounding grows along the path; 1e-9 m is the project's bound.
  EXPECT_LT((in_current - in_still - current * duration).norm(), tolerance(1e-9));
}

TEST(EquationsOfMotion, TurningTheWorldTurnsThePath) {
  const Model model = galilean();
  const Quaternion turn(Eigen::AngleAxisd(2.1, Vec3::UnitZ()));
  const Vec3 current(0.3, 0.1, 0);
  VehicleState turned;
  turned.orientation = turn;
  const Vec3 path = run(model, {}, kAhead, {.current_ned_mps = current}, 30, kStep).position_ned_m;
  const Vec3 turned_path =
      run(model, turned, kAhead, {.current_ned_mps = turn * current}, 30, kStep).position_ned_m;
  EXPECT_LT((turned_path - turn * path).norm(), tolerance(1e-9));
}

TEST(EquationsOfMotion, ThePublishedCurrentIsTheExactOneForALevelHullThatSeesNoPropeller) {
  VehicleState level = random_state(3);
  level.orientation = to_quaternion({0, 0, 1.1});
  level.velocity_body.segment<2>(3).setZero();
  const Water water{.current_ned_mps = current_toward(0.5, 40)};
  EXPECT_LT((acceleration(published(), level, water) - acceleration(galilean(), level, water)).norm(),
            tolerance(1e-12));
}

TEST(EquationsOfMotion, EnergyNeverGrowsWithoutActuatorsAndCurrent) {
  for (const double buoyancy_ratio : {1.0, 0.98}) {
    ModelParameters parameters = remus100_pvs_parameters(CurrentTreatment::kUpstream);
    parameters.buoyancy_n *= buoyancy_ratio;
    const Model model(parameters);
    for (std::uint32_t who = 0; who < 1000; ++who) {
      VehicleState state = random_state(who);
      double energy = mechanical_energy_j(model, state);
      const double allowance = 1e-9 * std::abs(energy);  // rounding, and the method's error of 4th order
      for (int i = 0; i < 50; ++i) {
        state = rk4_step(model, state, {}, {}, kStep);
        const double next = mechanical_energy_j(model, state);
        ASSERT_LE(next, energy + allowance) << "state " << who << ", step " << i;
        energy = next;
      }
    }
  }
}

TEST(EquationsOfMotion, AVehicleAtRestInTrimStaysThere) {
  const VehicleState state = run(published(), {}, {}, {}, 60, kStep);
  EXPECT_EQ(state.position_ned_m, Vec3::Zero());
  EXPECT_EQ(state.velocity_body, Vec6::Zero());
}

TEST(EquationsOfMotion, SteadySpeedsAreThePublishedOnes) {
  for (const auto& [rpm, speed] : {std::pair{1000, 1.6741}, {1200, 2.0093}, {1525, 2.5536}}) {
    const VehicleState state = run(published(), {}, {0, 0, rpm / 60.0}, {}, 120, kStep);
    EXPECT_NEAR(state.linear_velocity_body_mps().norm(), speed, tolerance(1e-4))
        << rpm;  // four decimals are given
  }
}

TEST(EquationsOfMotion, TurningRadiiAreThePublishedOnes) {
  for (const auto& [degrees, radius] : {std::pair{5, 40.4}, {10, 24.6}, {15, 18.5}}) {
    const VehicleState state = run(published(), {}, {to_radians(degrees), 0, 1525.0 / 60}, {}, 180, kStep);
    const double horizontal_speed = (state.orientation * state.linear_velocity_body_mps()).head<2>().norm();
    const double yaw_rate = (state.orientation * Vec3(state.angular_velocity_body_radps())).z();
    EXPECT_NEAR(horizontal_speed / yaw_rate, radius, tolerance(0.06)) << degrees;  // one decimal is given
  }
}

TEST(EquationsOfMotion, NegativeSternPlanesRaiseTheBow) {
  const VehicleState state = run(published(), {}, {0, to_radians(-5), 1525.0 / 60}, {}, 10, kStep);
  EXPECT_GT(to_euler(state.orientation).pitch, 0);
  EXPECT_LT(state.position_ned_m.z(), 0);
}

TEST(EquationsOfMotion, CommandsBeyondTheLimitsActAsTheLimits) {
  const ActuatorValues beyond{1, -1, 1000}, limit{to_radians(15), to_radians(-15), 1525.0 / 60};
  EXPECT_EQ(run(published(), {}, beyond, {}, 5, kStep).position_ned_m,
            run(published(), {}, limit, {}, 5, kStep).position_ned_m);
}

TEST(EquationsOfMotion, ANumberThatIsNotFiniteShowsInTheState) {
  EXPECT_TRUE(is_finite(run(published(), {}, kAhead, {}, 1, kStep)));
  const Water broken{.current_ned_mps = {std::nan(""), 0, 0}};
  EXPECT_FALSE(is_finite(run(published(), {}, kAhead, broken, 1, kStep)));
}

}  // namespace
}  // namespace halocline::vehicle_sim
