// SPDX-License-Identifier: BSD-3-Clause
// What the vehicles of models/vehicles that are files obey, and how those without fins move.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/archive.h"
#include "core/random.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/dynamics/mechanical_energy.h"
#include "tests/vehicle_sim/shipped/shipped_model.h"
#include "tests/vehicle_sim/world/grounds.h"
#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/fleet.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::at_ms;
using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::run;
using testing::shipped;

SimTime at_s(double seconds) { return SimTime::from_seconds(seconds); }

double uniform(std::uint32_t who, std::uint64_t which, double low, double high) {
  return low + (high - low) * uniform_at({.seed = 17, .purpose = 3, .who = who, .which = which});
}

VehicleState random_state(std::uint32_t who) {
  VehicleState s;
  s.orientation = to_quaternion({uniform(who, 0, -3, 3), uniform(who, 1, -1.5, 1.5), uniform(who, 2, -3, 3)});
  for (int k = 0; k < 3; ++k) s.velocity_body[k] = uniform(who, 3 + k, -2, 2);
  for (int k = 3; k < 6; ++k) s.velocity_body[k] = uniform(who, 3 + k, -1, 1);
  return s;
}

class UnderWater : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, UnderWater, ::testing::Values("glider", "drifter", "lander"),
                         [](const auto& test) { return test.param; });

// What is heavier than its water moves at a speed that changes what drag takes, but never gains from it.
TEST_P(UnderWater, EnergyNeverGrowsWithoutActuators) {
  const auto model = shipped(GetParam());
  for (std::uint32_t who = 0; who < 200; ++who) {
    VehicleState state = random_state(who);
    double energy = mechanical_energy_j(*model, state);
    const double allowance = tolerance(1e-9) * std::abs(energy);
    for (int i = 0; i < 50; ++i) {
      state = rk4_step(*model, state, {}, {}, 0.005);
      const double next = mechanical_energy_j(*model, state);
      ASSERT_LE(next, energy + allowance) << "state " << who << ", step " << i;
      energy = next;
    }
  }
}

TEST_P(UnderWater, ASteadyCurrentOnlyCarriesThePathAlong) {
  const auto model = shipped(GetParam());
  const Vec3 current(0.3, -0.4, 0.1);
  const ActuatorValues command{.rudder_rad = 0.05, .buoyancy_m3 = -2e-4, .moving_mass_m = 0.01};
  VehicleState carried;
  carried.velocity_body.head<3>() = current;
  const Vec3 in_still = run(*model, {}, command, 120).position_ned_m;
  const Vec3 in_current = run(*model, carried, command, 120, {.current_ned_mps = current}).position_ned_m;
  EXPECT_LT((in_current - in_still - current * 120).norm(), tolerance(1e-9));  // the project's bound
}

// How far a vehicle at `depth_m` goes in tide and gusts, the same everywhere, less the way of the water: the
// integral of what changes evenly within a step is the trapezoids'.
Vec3 lag_behind_water(const std::string& name, double depth_m, const CurrentSettings& currents) {
  FleetSettings settings;
  settings.current = currents;
  OceanCurrent current(settings.current, settings.seed);
  const auto water = [&](SimTime t) { return current.everywhere(t, settings.step).velocity_mps; };
  VehicleState start;
  start.position_ned_m.z() = depth_m;
  start.velocity_body.head<3>() = water(SimTime());
  Fleet fleet(settings, {{"one", shipped(name), start}}, nullptr, SimTime());
  Vec3 way = Vec3::Zero();
  for (int ms = 0; ms < 120'000; ms += 10) way += 0.005 * (water(at_ms(ms)) + water(at_ms(ms + 10)));
  fleet.advance(at_s(120));
  return fleet.state_at(0, at_s(120)).position_ned_m - start.position_ned_m - way;
}

const CurrentSettings kSteady{.uniform_ned_mps = {0.3, 0.2, 0}, .by_depth = {}, .tide = {}, .random = {}};
const CurrentSettings kTideAndGusts{
    .uniform_ned_mps = {0.1, 0.2, 0},
    .by_depth = {},
    .tide = {.amplitude_mps = 0.8, .period_s = 50, .phase_rad = 0.3, .toward_rad = 1},
    .random = {.deviation_mps = 0.3, .time_s = 20}};

TEST(Drifter, FollowsTheCurrentExactly) {
  EXPECT_LT(lag_behind_water("drifter", 30, kSteady).norm(), tolerance(1e-9));
  EXPECT_LT(lag_behind_water("drifter", 30, kTideAndGusts).norm(), tolerance(1e-9));
}

// Afloat at its draught. Water that accelerates pushes at the middle of the wet part, 15 cm above the centre
// of gravity: the hull swings, by 2 mm here.
TEST(Buoy, DriftsWithTheCurrent) {
  const Vec3 steady = lag_behind_water("buoy", 0.4, kSteady);
  EXPECT_LT(steady.head<2>().norm(), tolerance(1e-9));
  EXPECT_NEAR(steady.z(), 0, tolerance(1e-6));  // its mass is written to a gram
  EXPECT_LT(lag_behind_water("buoy", 0.4, kTideAndGusts).head<2>().norm(), tolerance(2e-3));
}

// In a table by depth the drifter takes up the speed of its depth. Of v' = -d v - c v^2, d = D / M and c =
// 1/2 rho C A / M, is left 1 / v = (1 / v0 + c / d) exp(d t) - c / d. The drag tilts it a little, for its
// centre of gravity is low: 1e-4 m/s.
TEST(Drifter, TakesUpTheSpeedOfItsDepth) {
  const auto model = shipped("drifter");
  const double mass = model->mass()(0, 0), c = 0.5 * 1025 * 0.47 * std::numbers::pi * 0.216 * 0.216 / mass,
               d = 5 / mass;
  FleetSettings settings;
  settings.current.by_depth = {{0, 0.5, 0}, {100, 0.1, 0}};
  VehicleState start;
  start.position_ned_m.z() = 50;  // the current is 0.3 m/s
  Fleet fleet(settings, {{"one", model, start}}, nullptr, SimTime());
  for (const double t : {5.0, 20.0, 60.0}) {
    fleet.advance(at_s(t));
    const double left = 1 / ((1 / 0.3 + c / d) * std::exp(d * t) - c / d);
    EXPECT_NEAR(fleet.state_at(0, at_s(t)).velocity_body[0], 0.3 - left, tolerance(1e-4));
  }
}

// w = sqrt(2 (W - B) / (rho C A)), whatever is on top.
double terminal_speed(double net_weight_n) {
  return std::sqrt(2 * std::abs(net_weight_n) / (1025 * std::numbers::pi / 4));
}

TEST(Lander, SinksAtItsTerminalSpeed) {
  const auto model = shipped("lander");
  const double net = model->weight_n() - model->parameters().buoyancy_n;
  EXPECT_NEAR(net, 339, 0.1);
  const VehicleState s = run(*model, {}, {}, 60);
  EXPECT_LT(relative_error(s.velocity_body[2], terminal_speed(net)), tolerance(1e-6));
}

TEST(Lander, RisesAtTheTerminalSpeedWithoutItsWeight) {
  const Model light(without_weight(shipped("lander")->parameters()));
  const double net = light.weight_n() - light.parameters().buoyancy_n;
  EXPECT_LT(net, 0);
  const VehicleState s = run(light, {}, {}, 60);
  EXPECT_LT(relative_error(-s.velocity_body[2], terminal_speed(net)), tolerance(1e-6));
}

// Sinks 60 m, lies on the ground by its net weight, drops the weight at the command, rises, and floats by
// Archimedes.
TEST(Lander, SinksRestsReleasesAndFloats) {
  const auto model = shipped("lander");
  VehicleState start;
  start.position_ned_m.z() = 2;
  Fleet fleet({}, {{"lander", model, start}}, testing::flat(60), SimTime());
  fleet.advance(at_s(50));
  EXPECT_FALSE(fleet.on_seabed(0));
  fleet.advance(at_s(90));
  EXPECT_TRUE(fleet.on_seabed(0));
  EXPECT_TRUE(fleet.reading_at(0, at_s(90)).on_seabed);
  const Vec3 there = fleet.state_at(0, at_s(90)).position_ned_m;
  EXPECT_NEAR(there.z(), 59.5, tolerance(0.01));  // its sphere of 1 m, contact to 1 cm
  fleet.advance(at_s(300));
  EXPECT_LT((fleet.state_at(0, at_s(300)).position_ned_m - there).norm(), tolerance(1e-3));
  EXPECT_EQ(fleet.command(0, {at_s(300), {.weight = DropWeightState::kReleased}}), CommandVerdict::kTaken);
  fleet.advance(at_s(301));
  EXPECT_EQ(fleet.reading_at(0, at_s(301)).actuators.weight, DropWeightState::kReleased);
  fleet.advance(at_s(320));  // the command is void by now, the weight is gone
  EXPECT_LT(relative_error(-fleet.state_at(0, at_s(320)).velocity_body[2], terminal_speed(343.35)),
            tolerance(1e-3));
  fleet.advance(at_s(900));
  const VehicleState afloat = fleet.state_at(0, at_s(900));
  EXPECT_LT(std::abs(afloat.position_ned_m.z()), 0.5);
  EXPECT_LT(afloat.velocity_body.norm(), 1e-2);
}

TEST(Lander, ComesBackFromAnArchiveWithoutItsWeight) {
  const auto model = shipped("lander");
  VehicleState start;
  start.position_ned_m.z() = 100;
  const auto new_fleet = [&] { return Fleet({}, {{"lander", model, start}}, nullptr, SimTime()); };
  Fleet fleet = new_fleet(), restarted = new_fleet();
  EXPECT_EQ(fleet.command(0, {SimTime(), {.weight = DropWeightState::kReleased}}), CommandVerdict::kTaken);
  fleet.advance(at_s(5));
  Archive saved;
  saved(fleet);
  Archive(saved.bytes())(restarted);
  for (Fleet* one : {&fleet, &restarted}) one->advance(at_s(20));
  EXPECT_EQ(fleet.state_at(0, at_s(20)).position_ned_m, restarted.state_at(0, at_s(20)).position_ned_m);
  EXPECT_LT(restarted.state_at(0, at_s(20)).velocity_body[2], -0.9);
}

// Body and weight together are the body that sinks: mass, moments and inertia about the common centre
// (Steiner).
TEST(Lander, BodyAndWeightMakeTheWhole) {
  const ModelParameters whole = shipped("lander")->parameters(), body = without_weight(whole);
  const DropWeight& w = whole.drop_weight;
  EXPECT_NEAR(body.mass_kg + w.mass_kg, whole.mass_kg, tolerance(1e-12));
  EXPECT_LT((body.mass_kg * body.center_of_gravity_m + w.mass_kg * w.position_m -
             whole.mass_kg * whole.center_of_gravity_m)
                .norm(),
            tolerance(1e-10));
  EXPECT_LT((body.buoyancy_n * body.center_of_buoyancy_m + w.buoyancy_n * w.position_m -
             whole.buoyancy_n * whole.center_of_buoyancy_m)
                .norm(),
            tolerance(1e-9));
  const auto about = [](double mass, const Vec3& d) {
    return Mat3(mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose()));
  };
  const Mat3 sum = body.inertia_kg_m2 +
                   about(body.mass_kg, body.center_of_gravity_m - whole.center_of_gravity_m) +
                   about(w.mass_kg, w.position_m - whole.center_of_gravity_m);
  EXPECT_LT((sum - whole.inertia_kg_m2).norm(), tolerance(1e-10));
}

TEST(SafeState, OfAGliderIsLightSoThatItComesUp) {
  VehicleState start;
  start.position_ned_m.z() = 40;
  Fleet fleet({}, {{"glider", shipped("glider"), start}}, nullptr, SimTime());
  fleet.advance(at_s(300));
  EXPECT_TRUE(fleet.reading_at(0, at_s(300)).safe_state);
  EXPECT_LT(fleet.state_at(0, at_s(300)).position_ned_m.z(), 1);
}

}  // namespace
}  // namespace halocline::vehicle_sim
