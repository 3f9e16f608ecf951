// SPDX-License-Identifier: BSD-3-Clause
// Vehicles in the ODE world: free flight is the equations' own, contact holds what it should.
#include "vehicle_sim/world/vehicle_world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/dynamics/reference_motion.h"
#include "tests/vehicle_sim/world/formula_seabed.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;
using testing::at;
using testing::deepest_in;
using testing::flat;
using testing::SeabedPointer;

constexpr ActuatorValues kFullAhead{0, 0, 1525.0 / 60};
constexpr double kMaxPenetration = 0.02;  // m, the project's bound

std::shared_ptr<const Model> remus(double buoyancy_ratio) {
  ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kGalilean);
  p.buoyancy_n *= buoyancy_ratio;
  return std::make_shared<const Model>(p);
}

struct Outcome {
  VehicleState end;
  double deepest_m = -std::numeric_limits<double>::infinity();
  Vec3 mean_force = Vec3::Zero();  // of the seabed over the last second
  double peak_speed = 0;
};

Outcome run(const SeabedPointer& seabed, double buoyancy_ratio, const VehicleState& start,
            const ActuatorValues& command, double duration_s, double step_s) {
  VehicleWorld world(seabed);
  world.add(remus(buoyancy_ratio), start);
  world.set_command(0, command);
  Outcome result;
  const long steps = std::lround(duration_s / step_s), last_second = std::lround(1 / step_s);
  for (long i = 0; i < steps; ++i) {
    world.step(step_s);
    EXPECT_FALSE(world.has_diverged(0));
    if (i % std::lround(0.04 / step_s) == 0) {
      const double depth = deepest_in(*seabed, world.state(0), world.model(0).parameters().hull);
      result.deepest_m = std::max(result.deepest_m, depth);
    }
    result.peak_speed = std::max(result.peak_speed, world.state(0).velocity_body.head<3>().norm());
    if (i >= steps - last_second) result.mean_force += world.seabed_force_ned_n(0) / last_second;
  }
  result.end = world.state(0);
  return result;
}

class Grounding : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(AtStep, Grounding, ::testing::Values(0.005, 0.01, 0.02), [](const auto& step) {
  return std::to_string(std::lround(step.param * 1000)) + "ms";
});

TEST_P(Grounding, AHeavyVehicleSinksToAFlatBottomAndRestsOnItWithWeightLessBuoyancy) {
  const Outcome r = run(flat(10), 0.98, at({0, 0, 9}), {}, 60, GetParam());
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
  const double expected = 0.02 * remus(1)->weight_n();
  EXPECT_NEAR(-r.mean_force.z(), expected, tolerance(0.01) * expected);
  EXPECT_LT(r.end.velocity_body.norm(), tolerance(1e-3));
  EXPECT_NEAR(r.end.position_ned_m.z(), 10 - 0.095, tolerance(2e-3));
}

TEST_P(Grounding, ADiveIntoAFlatBottomAtFullSpeedIsStopped) {
  const Outcome r = run(flat(10), 1, at({0, 0, 8}, {0, -to_radians(40), 0}, 2.5), kFullAhead, 20, GetParam());
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
  EXPECT_LT(r.peak_speed, 3);
}

TEST_P(Grounding, AVerticalDiveIsStopped) {
  const Outcome r =
      run(flat(10), 0.98, at({0, 0, 8}, {0, -to_radians(89), 0}, 2.5), kFullAhead, 20, GetParam());
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
}

TEST_P(Grounding, AVehicleRunsUpASlopeOfThirtyDegrees) {
  const auto seabed = testing::ramp(10, 5, to_radians(30));
  const Outcome r = run(seabed, 1, at({0, 0, 9}, {}, 2.5), kFullAhead, 20, GetParam());
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
  EXPECT_GT(r.end.position_ned_m.x(), 6);
}

TEST_P(Grounding, AVehicleRestsOnASlopeOfTenDegrees) {
  for (const double yaw :
       {0.0, std::numbers::pi / 2}) {  // a hull at another heading pivots on its one contact
    const auto seabed = testing::slope(10, to_radians(10));
    const Outcome r = run(seabed, 0.98, at({0, 0, 9.7}, {0, 0, yaw}), {}, 40, GetParam());
    const double expected = 0.02 * remus(1)->weight_n();
    EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration)) << yaw;
    EXPECT_NEAR(-r.mean_force.z(), expected, tolerance(0.01) * expected) << yaw;
    EXPECT_LT(r.end.velocity_body.norm(), tolerance(1e-3)) << yaw;
  }
}

TEST_P(Grounding, AVehicleDroppedOnASharpRidgeIsNotCutByIt) {
  struct Drop {
    double angle_deg, yaw, off_m;  // across, askew and along the crest; on it and beside it
  };
  for (const Drop& d : {Drop{20, 0, 0},
                        {45, 0, 0.3},
                        {60, 0, 0},
                        {45, 0.4, 0.03},
                        {20, std::numbers::pi / 2, 0.03},
                        {60, std::numbers::pi / 2, 0}}) {
    const auto seabed = testing::ridge(10, to_radians(d.angle_deg));
    const Outcome r = run(seabed, 0.95, at({d.off_m, 0, 9.5}, {0, 0, d.yaw}), {}, 12, GetParam());
    EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration)) << d.angle_deg << " degrees, yaw " << d.yaw;
  }
}

TEST_P(Grounding, AVehicleDriftsSidewaysIntoASteepWallAndStops) {
  const auto wall = testing::ramp(10, 2, to_radians(70));
  VehicleState start = at({1, 0, 9.9}, {0, 0, std::numbers::pi / 2});
  start.velocity_body[1] = -1;  // to port, which is north
  const Outcome r = run(wall, 0.99, start, {}, 10, GetParam());
  EXPECT_LT(r.deepest_m * std::cos(to_radians(70)),
            tolerance(kMaxPenetration));  // across the wall, not vertical
}

TEST(VehicleWorld, FreeFlightIsTheSolutionOfTheEquationsToTheLastBit) {
  const auto model = remus(1);
  VehicleState alone = at({3, 4, 50}, {0.1, 0.2, 0.3}, 1);
  VehicleWorld world(flat(200));
  world.add(model, alone);
  const ActuatorValues command{0.1, -0.05, 20};
  world.set_command(0, command);
  for (int i = 0; i < 1000; ++i) {
    world.step(0.01);
    alone = rk4_step(*model, alone, command, {}, 0.01);
  }
  EXPECT_EQ(world.state(0).position_ned_m, alone.position_ned_m);
  EXPECT_EQ(world.state(0).velocity_body, alone.velocity_body);
  EXPECT_EQ(world.seabed_force_ned_n(0), Vec3::Zero());
}

// Guards the formulation: the force we apply takes ODE's body to the Runge-Kutta velocity by itself.
TEST(VehicleWorld, PublishedMotionHoldsInTheWorldToo) {
  const auto model = std::make_shared<const Model>(remus100_pvs_parameters(CurrentTreatment::kUpstream));
  const auto samples = testing::read_trajectory("vehicle/exact/c_stern_1525_m5.csv");
  VehicleWorld world(nullptr);
  world.add(model, testing::to_state(samples.front()));
  for (std::size_t i = 1; i < samples.size(); ++i) {
    world.set_command(0, samples[i - 1].command);
    for (int k = 0; k < 100; ++k) world.step(0.01);
    ASSERT_LT((world.state(0).position_ned_m - samples[i].position).norm(), tolerance(1e-3));
  }
}

std::vector<VehicleState> mission(int vehicles) {
  VehicleWorld world(testing::ridge(12, to_radians(30)));
  for (int i = 0; i < vehicles; ++i) {
    world.add(remus(0.97), at({i * 0.5 - 2, i * 3.0, 10}, {0, -0.3, 0.2 * i}, 1.5));
    world.set_command(i, {0.02 * i, 0.1, 15});
  }
  for (int k = 0; k < 1000; ++k) world.step(0.01);
  std::vector<VehicleState> states;
  for (int i = 0; i < vehicles; ++i) states.push_back(world.state(i));
  return states;
}

bool same_bytes(const std::vector<VehicleState>& a, const std::vector<VehicleState>& b) {
  const auto same = [](const VehicleState& x, const VehicleState& y) {
    return std::memcmp(&x.position_ned_m, &y.position_ned_m, sizeof x.position_ned_m) == 0 &&
           std::memcmp(&x.orientation, &y.orientation, sizeof x.orientation) == 0 &&
           std::memcmp(&x.velocity_body, &y.velocity_body, sizeof x.velocity_body) == 0;
  };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), same);
}

TEST(VehicleWorld, WorldsInTwoThreadsGiveTheBytesOfOne) {
  const auto expected = mission(6);
  std::vector<VehicleState> first, second;
  std::thread one([&] { first = mission(6); }), two([&] { second = mission(6); });
  one.join();
  two.join();
  EXPECT_TRUE(same_bytes(first, expected));
  EXPECT_TRUE(same_bytes(second, expected));
}

// Vehicles do not meet in ODE: how many there are may change none of them.
TEST(VehicleWorld, OthersInTheWorldChangeNothing) {
  const auto many = mission(6);
  EXPECT_TRUE(same_bytes(mission(2), {many.begin(), many.begin() + 2}));
}

TEST(VehicleWorld, AVehicleWhoseEquationsFailHasDivergedAndTheOthersGoOn) {
  VehicleWorld world(flat(100));
  VehicleState runaway = at({0, 0, 10});
  runaway.velocity_body[1] = 1e200;  // its square overflows
  world.add(remus(1), runaway);
  world.add(remus(1), at({0, 9, 10}, {}, 1));
  for (int i = 0; i < 100; ++i) world.step(0.01);
  EXPECT_TRUE(world.has_diverged(0));
  EXPECT_TRUE(is_finite(world.state(0)));
  EXPECT_FALSE(world.has_diverged(1));
  EXPECT_GT(world.state(1).position_ned_m.x(), 0.5);
}

TEST(VehicleWorld, AVehiclePlacedInTheSeabedIsMovedOutSlowly) {
  const Outcome r = run(flat(10), 0.98, at({0, 0, 10.5}), {}, 30, 0.01);
  EXPECT_LT(r.peak_speed, 0.5);
  EXPECT_LT(deepest_in(*flat(10), r.end, remus(1)->parameters().hull), tolerance(kMaxPenetration));
}

TEST(VehicleWorld, BeyondTheMapThereIsNoSeabed) {
  class Nowhere : public Seabed {
    std::optional<SeabedPlane> plane_at(double, double) const override { return {}; }
  };
  VehicleWorld world(std::make_shared<Nowhere>());
  world.add(remus(0.9), at({0, 0, 0}));
  for (int i = 0; i < 1000; ++i) world.step(0.01);
  EXPECT_GT(world.state(0).position_ned_m.z(), 3);
}

TEST(VehicleWorld, WhatIsImpossibleIsRefused) {
  VehicleWorld world(nullptr);
  EXPECT_THROW(world.add(nullptr, {}), InvalidArgument);
  VehicleState bad;
  bad.orientation.w() = 2;
  EXPECT_THROW(world.add(remus(1), bad), InvalidArgument);
  world.add(remus(1), {});
  EXPECT_THROW(world.set_command(0, {std::nan(""), 0, 0}), InvalidArgument);
  EXPECT_THROW(world.set_water(0, {.current_ned_mps = {0, std::nan(""), 0}}), InvalidArgument);
  EXPECT_THROW(world.step(0), InvalidArgument);
  EXPECT_THROW(world.step(0.1), InvalidArgument);
  EXPECT_THROW(VehicleWorld(nullptr, -1), InvalidArgument);
}

}  // namespace
}  // namespace halocline::vehicle_sim
