// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/faults.h"

#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/model_library.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGravity = 9.81, kDensity = 1026;

SimTime at_s(double s) { return SimTime::from_seconds(s); }

// A neutral body without fins and propeller: 50 kg, 20 kg of added mass in heave.
ModelParameters plain_body() {
  ModelParameters p;
  p.name = "body";
  p.hull = {1.5, 0.4};
  p.mass_kg = 50;
  p.buoyancy_n = 50 * kGravity;
  p.added_mass.diagonal() << 5, 20, 20, 1, 1, 1;
  return p;
}

Fleet fleet_of(const ModelParameters& parameters, double speed_mps = 0) {
  VehicleState start;
  start.position_ned_m.z() = 50;
  start.velocity_body[0] = speed_mps;
  return Fleet({}, {{"one", std::make_shared<const Model>(parameters), start}}, nullptr, SimTime());
}

Fault leak(double rate_kg_s, double volume_m3) {
  return {
      .from = SimTime(), .kind = FaultKind::kLeak, .leak_rate_kg_s = rate_kg_s, .leak_volume_m3 = volume_m3};
}

// Water in the first vehicle, a plain body.
double water_inside_kg(const Fleet& fleet) {
  return fleet.faults(0).broken(plain_body()).mass_kg - plain_body().mass_kg;
}

// M w' = g k t - D w with M = M0 + k t. With s = M and a = D / k:
// w = g / k (s / (a + 1) - M0 / a + M0 (M0 / s)^a (1 / a - 1 / (a + 1))).
TEST(Faults, ALeakingVehicleSinksByItsGrowingWeightAndMass) {
  ModelParameters p = plain_body();
  p.damping.linear << 40, 40, 40, 1, 1, 1;
  Fleet fleet = fleet_of(p);
  const double k = 0.05, first = 70, a = 40 / k;
  EXPECT_TRUE(fleet.apply_fault(0, leak(k, 1)));
  for (const double t : {5.0, 20.0, 60.0}) {
    fleet.advance(at_s(t));
    const double s = first + k * t;
    const double w =
        kGravity / k * (s / (a + 1) - first / a + first * std::pow(first / s, a) * (1 / a - 1 / (a + 1)));
    EXPECT_NEAR(fleet.state_at(0, at_s(t)).velocity_body[2], w, tolerance(1e-6));
    EXPECT_NEAR(water_inside_kg(fleet), k * t, tolerance(1e-9));
  }
}

TEST(Faults, AFullHullSinksAtTheRateThatLinearDampingLeaves) {
  ModelParameters p = plain_body();
  p.damping.linear << 40, 40, 40, 1, 1, 1;
  Fleet fleet = fleet_of(p);
  EXPECT_TRUE(fleet.apply_fault(0, leak(0.05, 0.002)));
  fleet.advance(at_s(200));
  const double inside = 0.002 * kDensity;
  EXPECT_NEAR(water_inside_kg(fleet), inside, tolerance(1e-12));
  EXPECT_NEAR(fleet.state_at(0, at_s(200)).velocity_body[2], kGravity * inside / 40, tolerance(1e-9));
}

// Drag of the strips, 1/2 rho C_d d L w^2.
TEST(Faults, AFullHullSinksAtTheRateThatCrossFlowLeaves) {
  ModelParameters p = plain_body();
  p.cross_flow = {
      .drag_coefficient = 1.1, .strip_length_m = 1.5 / 20, .strips = 20, .planes = CrossFlowPlanes::kBoth};
  Fleet fleet = fleet_of(p);
  EXPECT_TRUE(fleet.apply_fault(0, leak(0.05, 0.002)));
  fleet.advance(at_s(300));
  const double pull = kGravity * 0.002 * kDensity;
  EXPECT_NEAR(fleet.state_at(0, at_s(300)).velocity_body[2],
              std::sqrt(2 * pull / (kDensity * 1.1 * 0.4 * 1.5)), tolerance(1e-9));
}

// Weight and buoyancy are equal when the hull is full: then it stands still where the common centre of
// gravity is right below the centre of buoyancy: tan(pitch) = -w x / (m z_g + w z), with the water w at (x,
// z).
TEST(Faults, WaterInTheBowTrimsAHullUntilTheCommonCentreOfGravityIsBelowThatOfBuoyancy) {
  for (const double ahead : {0.3, -0.5}) {
    ModelParameters p = plain_body();
    const double water = 0.002 * kDensity, z_g = 0.02, below = 0.05;
    p.damping.linear << 40, 40, 40, 2, 4, 4;
    p.center_of_gravity_m.z() = z_g;
    p.leak_offset_m = {ahead, 0, below};
    p.buoyancy_n = (50 + water) * kGravity;
    Fleet fleet = fleet_of(p);
    EXPECT_TRUE(fleet.apply_fault(0, leak(0.1, 0.002)));
    fleet.advance(at_s(200));
    const VehicleState end = fleet.state_at(0, at_s(200));
    const double z = z_g + below;
    EXPECT_NEAR(std::tan(to_euler(end.orientation).pitch), -water * ahead / (50 * z_g + water * z),
                tolerance(1e-9));
    EXPECT_LT(end.velocity_body.norm(), tolerance(1e-9));
  }
}

TEST(Faults, AVehicleWithWaterInsideHasTheMassMatrixOfBothBodies) {
  ModelParameters p = plain_body();
  p.center_of_gravity_m = {0.1, 0, 0.02};
  p.leak_offset_m = {0.4, -0.1, 0.06};
  VehicleFaults faults;
  faults.take(leak(0.1, 1), {});
  faults.leak(30, kDensity);
  const Model both(faults.broken(p));
  const Mat6 sum = Model(p).rigid_body_mass() +
                   rigid_body_mass_matrix(3, Mat3::Zero(), p.center_of_gravity_m + p.leak_offset_m);
  EXPECT_LT((both.rigid_body_mass() - sum).norm(), tolerance(1e-12) * sum.norm());
}

TEST(Faults, AMendedLeakKeepsItsWaterAndANegativeRatePumpsItOut) {
  Fleet fleet = fleet_of(plain_body());
  EXPECT_TRUE(fleet.apply_fault(0, leak(0.1, 0.01)));
  Fault mended = leak(0.1, 0.01);
  mended.from = at_s(10);
  mended.mended = true;
  EXPECT_TRUE(fleet.apply_fault(0, mended));
  fleet.advance(at_s(20));
  EXPECT_NEAR(water_inside_kg(fleet), 1, tolerance(1e-9));
  EXPECT_TRUE(fleet.apply_fault(0, leak(-0.5, 0)));
  fleet.advance(at_s(30));
  EXPECT_EQ(water_inside_kg(fleet), 0);
  EXPECT_FALSE(fleet.faults(0).changes_model());
}

// u' = -c u^2 / M: u = u0 / (1 + c u0 t / M), c = 1/2 rho S C_D, M = 55 kg.
TEST(Faults, WithoutItsPropellerAVehicleCoastsAgainstItsDrag) {
  ModelParameters p = plain_body();
  p.body_lift = {.reference_area_m2 = 0.1, .axial_drag = 0.2};
  p.propeller = remus100_pvs_parameters(CurrentTreatment::kGalilean).propeller;
  Fleet fleet = fleet_of(p, 2);
  EXPECT_TRUE(fleet.apply_fault(0, {.from = SimTime(), .kind = FaultKind::kLostPropeller}));
  EXPECT_EQ(fleet.command(0, {SimTime(), {.propeller_hz = 20}}), CommandVerdict::kTaken);
  const double c = 0.5 * kDensity * 0.1 * 0.2;
  for (const double t : {0.5, 1.0, 1.9}) {
    fleet.advance(at_s(t));
    const VehicleState state = fleet.state_at(0, at_s(t));
    EXPECT_NEAR(state.velocity_body[0], 2 / (1 + c * 2 * t / 55), tolerance(1e-7));
    EXPECT_GT(state.actuators.propeller_hz, 5);  // the motor turns
  }
}

TEST(Faults, AMendedPropellerDrivesAgain) {
  const auto speed_after_a_minute = [](bool mend) {
    Fleet fleet = fleet_of(*programmed_model("torpedo"));
    EXPECT_TRUE(fleet.apply_fault(0, {.from = SimTime(), .kind = FaultKind::kLostPropeller}));
    if (mend) {
      EXPECT_TRUE(fleet.apply_fault(0, {.from = at_s(5), .kind = FaultKind::kLostPropeller, .mended = true}));
    }
    for (int s = 0; s < 30; ++s) {
      EXPECT_EQ(fleet.command(0, {at_s(s), {.propeller_hz = 20}}), CommandVerdict::kTaken);
      fleet.advance(at_s(s + 1));
    }
    return fleet.state_at(0, at_s(30)).velocity_body[0];
  };
  EXPECT_EQ(speed_after_a_minute(false), 0);
  EXPECT_GT(speed_after_a_minute(true), 1.5);
}

// Runs `seconds` with the rudder commanded and 1525 rpm.
void run(Fleet& fleet, double from_s, double seconds, double rudder_rad) {
  for (double s = from_s; s < from_s + seconds; ++s) {
    EXPECT_EQ(fleet.command(0, {at_s(s), {.rudder_rad = rudder_rad, .propeller_hz = 1525.0 / 60}}),
              CommandVerdict::kTaken);
    fleet.advance(at_s(s + 1));
  }
}

TEST(Faults, AStuckRudderTurnsACircleWhateverIsCommanded) {
  const ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kGalilean);
  Fleet stuck = fleet_of(p), steered = fleet_of(p);
  EXPECT_TRUE(
      stuck.apply_fault(0, {.from = SimTime(), .kind = FaultKind::kStuckRudder, .angle_rad = 10 * kDegree}));
  run(stuck, 0, 180, -10 * kDegree);
  run(steered, 0, 180, 10 * kDegree);
  const VehicleState state = stuck.state_at(0, at_s(180));
  EXPECT_EQ(state.position_ned_m, steered.state_at(0, at_s(180)).position_ned_m);
  // The published turn of this model at 10 degrees (docs/vehicles.md), to its last digit.
  EXPECT_NEAR(state.velocity_body.head<2>().norm() / state.velocity_body[5], 24.6, tolerance(0.05));
}

TEST(Faults, WithoutAnAngleARudderSticksWhereItIs) {
  Fleet fleet = fleet_of(*programmed_model("torpedo"));
  run(fleet, 0, 5, 5 * kDegree);
  const double there = fleet.state_at(0, at_s(5)).actuators.rudder_rad;
  EXPECT_NEAR(there, 5 * kDegree, 1e-3);
  EXPECT_TRUE(fleet.apply_fault(0, {.from = at_s(5), .kind = FaultKind::kStuckRudder}));
  run(fleet, 5, 5, -5 * kDegree);
  EXPECT_EQ(fleet.state_at(0, at_s(10)).actuators.rudder_rad, there);
  EXPECT_TRUE(fleet.apply_fault(0, {.from = at_s(10), .kind = FaultKind::kStuckRudder, .mended = true}));
  run(fleet, 10, 5, -5 * kDegree);
  EXPECT_NEAR(fleet.state_at(0, at_s(15)).actuators.rudder_rad, -5 * kDegree, 1e-3);
}

TEST(Faults, StuckSternPlanesHoldTheirOwnAngle) {
  VehicleFaults faults;
  faults.take({.from = SimTime(), .kind = FaultKind::kStuckSternPlanes, .angle_rad = 0.1}, {});
  const ActuatorValues obeyed =
      faults.obeyed({.rudder_rad = -0.2, .stern_planes_rad = -0.2, .propeller_hz = 9});
  EXPECT_EQ(obeyed, (ActuatorValues{.rudder_rad = -0.2, .stern_planes_rad = 0.1, .propeller_hz = 9}));
}

TEST(Faults, HoldFromTheirTimeOn) {
  Fleet fleet = fleet_of(plain_body());
  Fault later = leak(1, 1);
  later.from = at_s(3);
  EXPECT_TRUE(fleet.apply_fault(0, later));
  fleet.advance(at_s(3));
  EXPECT_EQ(water_inside_kg(fleet), 0);
  fleet.advance(at_s(4));
  EXPECT_NEAR(water_inside_kg(fleet), 1, tolerance(1e-9));
}

TEST(Faults, EachSensorFailsAndIsMendedByItself) {
  VehicleFaults faults;
  Fault dead{.from = SimTime(), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kDvl};
  faults.take(dead, {});
  dead.sensor = SensorKind::kGps;
  faults.take(dead, {});
  dead.mended = true;
  faults.take(dead, {});
  VehicleFaults::Dead expected = {};
  expected[static_cast<std::size_t>(SensorKind::kDvl)] = true;
  EXPECT_EQ(faults.dead_sensors(), expected);
}

TEST(Faults, BetweenStepsABrokenVehicleMovesAsItIs) {
  ModelParameters p = plain_body();
  Fleet fleet = fleet_of(p);
  EXPECT_TRUE(fleet.apply_fault(0, leak(10, 0.02)));
  fleet.advance(at_s(5));
  const double speed = fleet.state_at(0, at_s(5)).velocity_body[2];
  const double later = fleet.state_at(0, at_s(5.009)).velocity_body[2];
  const double inside = 0.02 * kDensity;
  EXPECT_NEAR((later - speed) / 0.009, kGravity * inside / (70 + inside), tolerance(1e-6));
}

TEST(Faults, AnImpossibleLeakIsRefused) {
  VehicleFaults faults;
  EXPECT_THROW(faults.take(leak(0.1, -1), {}), InvalidArgument);
  EXPECT_THROW(faults.take(leak(NAN, 1), {}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::vehicle_sim
