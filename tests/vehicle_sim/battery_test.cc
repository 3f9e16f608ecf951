// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/power/battery.h"

#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/sim_time.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/torpedo.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/fleet.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::at_ms;
using halocline::testing::tolerance;

Battery battery_of(double capacity_j, double hotel_w = 10, double efficiency = 0.5) {
  return Battery({capacity_j, hotel_w, efficiency});
}

TEST(Battery, WhatIsLeftIsTheCapacityLessWhatEachCauseTook) {
  Battery battery = battery_of(1000);
  battery.add_packet(at_ms(500), PacketEnergy::kTransmit, 7);
  battery.add_packet(at_ms(600), PacketEnergy::kReceive, 0.5);
  for (int i = 1; i <= 100; ++i) battery.spend(at_ms(10 * i), 0.01, 20);
  EXPECT_NEAR(battery.hotel_j(), 10, tolerance(1e-9));
  EXPECT_NEAR(battery.shaft_j(), 40, tolerance(1e-9));
  EXPECT_EQ(battery.transmit_j(), 7);
  EXPECT_EQ(battery.receive_j(), 0.5);
  EXPECT_NEAR(battery.left_j(), 1000 - 57.5, tolerance(1e-9));
}

TEST(Battery, APacketCountsALagAfterItsInstant) {
  Battery battery = battery_of(1000, 0);
  battery.add_packet(at_ms(500), PacketEnergy::kTransmit, 7);
  battery.spend(at_ms(590), 0.01, 0);
  EXPECT_EQ(battery.left_j(), 1000);
  battery.spend(at_ms(600), 0.01, 0);
  EXPECT_EQ(battery.left_j(), 993);
}

// 0.1 + 0.2 + 0.3 differs in its last bit by the order of the sum.
TEST(Battery, TheOrderInWhichPacketsBecomeKnownDoesNotMatter) {
  Battery forth = battery_of(1), back = battery_of(1);
  const double amounts[] = {0.1, 0.2, 0.3};
  for (int i = 0; i < 3; ++i) forth.add_packet(at_ms(i), PacketEnergy::kReceive, amounts[i]);
  for (int i = 2; i >= 0; --i) back.add_packet(at_ms(i), PacketEnergy::kReceive, amounts[i]);
  forth.spend(at_ms(200), 0.2, 0);
  back.spend(at_ms(200), 0.2, 0);
  EXPECT_EQ(forth.receive_j(), back.receive_j());
}

TEST(Battery, AnEmptyOneGivesNothingMore) {
  Battery battery = battery_of(1);
  for (int i = 1; i <= 100; ++i) battery.spend(at_ms(10 * i), 0.01, 0);
  EXPECT_TRUE(battery.is_empty());
  EXPECT_NEAR(battery.left_j(), 0, tolerance(0.1 + 1e-9));  // a step of 10 W
  const double left_j = battery.left_j();
  battery.spend(at_ms(2000), 1, 100);
  EXPECT_EQ(battery.left_j(), left_j);
}

TEST(Battery, RefusesWhatNoBatteryIs) {
  EXPECT_THROW(battery_of(-1), InvalidArgument);
  EXPECT_THROW(battery_of(1, -1), InvalidArgument);
  EXPECT_THROW(battery_of(1, 1, 0), InvalidArgument);
}

std::shared_ptr<const Model> torpedo() { return std::make_shared<const Model>(torpedo_parameters()); }

VehicleState running(double propeller_hz, double speed_mps) {
  VehicleState state;
  state.position_ned_m.z() = 50;
  state.velocity_body[0] = speed_mps;
  state.actuators.propeller_hz = propeller_hz;
  return state;
}

// 2 pi n rho D^5 (K_Q0 n^2 + (K_Qmax - K_Q0) / J_max (1 - w) u / D n).
TEST(ShaftPower, IsTheTorqueTimesTheTurnRate) {
  const auto model = torpedo();
  const Thruster& t = model->parameters().propeller;
  const double n = 20, u = 2, d = t.diameter_m;
  const double inflow = t.advance_speed_ratio * u / d * n / t.advance_max;
  const double k = t.torque_at_rest * n * n + (t.torque_at_max - t.torque_at_rest) * inflow;
  EXPECT_NEAR(shaft_power_w(*model, running(n, u), {}),
              2 * std::numbers::pi * n * model->parameters().water_density_kg_m3 * std::pow(d, 5) * k,
              tolerance(1e-9));
}

TEST(ShaftPower, GrowsWithTheCubeOfTheTurnRateAndNeverComesBack) {
  const auto model = torpedo();
  EXPECT_NEAR(shaft_power_w(*model, running(20, 0), {}) / shaft_power_w(*model, running(10, 0), {}), 8,
              tolerance(1e-9));
  EXPECT_GT(shaft_power_w(*model, running(-10, 0), {}), 0);
  EXPECT_EQ(shaft_power_w(*model, running(0, 2), {}), 0);
  EXPECT_EQ(shaft_power_w(*model, running(2, 10), {}), 0);  // the water drives it
}

class FleetWithBattery : public ::testing::Test {
 protected:
  Fleet fleet(double capacity_j, double hotel_w = 10) {
    return Fleet({}, {{"auv", torpedo(), running(20, 2), BatterySettings{capacity_j, hotel_w, 0.5}}}, nullptr,
                 SimTime());
  }
  static void run(Fleet& fleet, int until_ms) {
    while (fleet.time() < at_ms(until_ms)) {
      EXPECT_EQ(fleet.command(0, {fleet.time(), {.rudder_rad = 0.1, .propeller_hz = 20}}),
                CommandVerdict::kTaken);
      fleet.advance(fleet.time() + SimDuration::from_milliseconds(500));
    }
  }
};

TEST_F(FleetWithBattery, TheShaftTakesItsPowerOverItsEfficiency) {
  Fleet steady = fleet(1e6);
  run(steady, 30'000);  // it has its speed
  const double before_j = steady.battery(0)->shaft_j();
  const double power_w = shaft_power_w(*torpedo(), steady.state_at(0, steady.time()), {});
  run(steady, 31'000);
  // The speed still changes by parts in a thousand.
  EXPECT_NEAR((steady.battery(0)->shaft_j() - before_j) / (power_w / 0.5), 1, tolerance(5e-3));
}

TEST_F(FleetWithBattery, AnEmptyBatteryStopsThePropellerAndDeafensTheSensors) {
  Fleet short_lived = fleet(0.5 * 10);  // half a second of hotel alone
  run(short_lived, 20'000);
  EXPECT_FALSE(short_lived.faults(0).has_power());
  for (const bool dead : short_lived.faults(0).dead_sensors()) EXPECT_TRUE(dead);
  const VehicleState state = short_lived.state_at(0, short_lived.time());
  EXPECT_NEAR(state.actuators.propeller_hz, 0, tolerance(1e-6));
  const auto changes = short_lived.take_power_changes();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_FALSE(changes[0].has_power);
  EXPECT_LT(changes[0].at, at_ms(500));
  EXPECT_NEAR(short_lived.battery(0)->hotel_j() + short_lived.battery(0)->shaft_j(), 5, tolerance(2.0));
  EXPECT_TRUE(short_lived.take_power_changes().empty());
}

TEST_F(FleetWithBattery, AFaultTakesThePowerAwayAndItsEndGivesItBack) {
  Fleet restored = fleet(1e6);
  ASSERT_TRUE(restored.apply_fault(0, {.from = at_ms(1000), .kind = FaultKind::kEmptyBattery}));
  run(restored, 5000);
  EXPECT_FALSE(restored.faults(0).has_power());
  ASSERT_TRUE(
      restored.apply_fault(0, {.from = at_ms(6000), .kind = FaultKind::kEmptyBattery, .fixed = true}));
  run(restored, 20'000);
  EXPECT_TRUE(restored.faults(0).has_power());
  EXPECT_NEAR(restored.state_at(0, restored.time()).actuators.propeller_hz, 20, 0.1);
}

}  // namespace
}  // namespace halocline::vehicle_sim
