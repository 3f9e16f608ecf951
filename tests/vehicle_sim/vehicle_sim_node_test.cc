// SPDX-License-Identifier: BSD-3-Clause
// The node on memq: grids, commands, faults, threads.
#include "vehicle_sim/vehicle_sim_node.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/config/scenario.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/transport/node_identity.h"
#include "core/sim_time.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/client_messages.h"
#include "tests/vehicle_sim/vehicle_sim_node_fixture.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

TEST_F(VehicleSimNodeTest, StatesComeExactlyOnTheGridFromTimeZero) {
  make_node();
  run_until(at_ms(1000));
  ASSERT_EQ(states_["sub"].size(), 11u);
  for (std::size_t k = 0; k < states_["sub"].size(); ++k) {
    EXPECT_EQ(states_["sub"][k].utime, static_cast<std::int64_t>(k) * 100'000);
    EXPECT_EQ(states_["sub"][k].sequence, static_cast<std::int64_t>(k));
    EXPECT_EQ(states_["sub"][k].session, 77);
    EXPECT_EQ(states_["sub"][k].vehicle_id, 3);
  }
}

TEST_F(VehicleSimNodeTest, FixedVehiclesArePublishedAndExternalOnesAreNot) {
  make_node();
  run_until(at_ms(500));
  ASSERT_EQ(states_["buoy"].size(), 6u);
  EXPECT_EQ(states_["buoy"].back().position_ned_m[0], 50);
  EXPECT_EQ(sensors_["buoy"].back().depth_m, 5);
  EXPECT_TRUE(states_["guest"].empty());
}

TEST_F(VehicleSimNodeTest, TheMotionDoesNotDependOnTheRateOfPublishing) {
  config_.state_period = SimDuration::from_milliseconds(33);
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0.1, 0, 20});
  run_until(at_ms(990));
  const vehicle_state_t often = states_["sub"].back();
  states_.clear();
  now_ = SimTime();
  config_.state_period = SimDuration::from_milliseconds(990);
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0.1, 0, 20});
  run_until(at_ms(990));
  const vehicle_state_t seldom = states_["sub"].back();
  ASSERT_EQ(often.utime, seldom.utime);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(often.position_ned_m[k], seldom.position_ned_m[k]);
}

TEST_F(VehicleSimNodeTest, ACommandMovesTheVehicleAndItsAbsenceStopsThePropeller) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0, 0, 20});
  run_until(at_ms(2000));
  EXPECT_GT(states_["sub"].back().velocity_ned_mps[0], 0.5);
  EXPECT_FALSE(sensors_["sub"].back().safe_state);
  EXPECT_GT(sensors_["sub"].back().shaft_rpm, 1000);
  run_until(at_ms(12'000));
  EXPECT_TRUE(sensors_["sub"].back().safe_state);
  EXPECT_LT(sensors_["sub"].back().shaft_rpm, 1);
}

TEST_F(VehicleSimNodeTest, ACommandForLaterWaitsForItsTime) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(500), {0, 0, 20});
  run_until(at_ms(500));
  EXPECT_EQ(states_["sub"].back().velocity_ned_mps[0], 0);
  run_until(at_ms(1000));
  EXPECT_GT(states_["sub"].back().velocity_ned_mps[0], 0);
}

TEST_F(VehicleSimNodeTest, ACommandTooOldIsCountedAndIgnored) {
  make_node();
  run_until(at_ms(5000));
  command(at_ms(1000), {0, 0, 20});
  run_until(at_ms(6000));
  EXPECT_EQ(states_["sub"].back().velocity_ned_mps[0], 0);
  EXPECT_EQ(node_->counters().late, 1);
}

TEST_F(VehicleSimNodeTest, AnImpossibleCommandIsRefused) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {std::nan(""), 0, 20});
  run_until(at_ms(1000));
  EXPECT_EQ(node_->counters().refused, 1);
  EXPECT_EQ(states_["sub"].back().velocity_ned_mps[0], 0);
}

TEST_F(VehicleSimNodeTest, ACurrentReceivedOnTheBusMovesTheVehicles) {
  make_node();
  run_until(at_ms(500));
  CurrentSettings east;
  east.uniform_ned_mps = {0, 0.5, 0};
  ear_.publish(bus::channels::kSetCurrent, to_current_message(at_ms(1000), east));
  drain();
  run_until(at_ms(30'000));
  EXPECT_EQ(states_["sub"][10].velocity_ned_mps[1], 0);
  EXPECT_GT(states_["sub"].back().velocity_ned_mps[1], 0.1);
}

TEST_F(VehicleSimNodeTest, TheRayClientNameHoldsTheSession) {
  make_node();
  run_until(at_ms(0));
  const std::string first = last_client_;
  EXPECT_TRUE(is_valid_name(first));
  node_ = std::make_unique<VehicleSimNode>(lcm_, bus::NodeIdentity{"vehicle-sim", 78}, scenario_of_two(),
                                           config_, nullptr);
  now_ = SimTime();
  run_until(at_ms(0));
  EXPECT_NE(last_client_, first);
}

TEST_F(VehicleSimNodeTest, TheSeabedIsFelt) {
  config_.buoyancy_over_weight = 0.95;
  make_node(testing::flat(21));
  run_until(at_ms(30'000));
  EXPECT_TRUE(sensors_["sub"].back().on_seabed);
  EXPECT_NEAR(states_["sub"].back().position_ned_m[2], 21 - 0.095, tolerance(2e-3));
}

TEST_F(VehicleSimNodeTest, StartedIntoARunningSimulationItJoinsOnTheGrid) {
  make_node();
  now_ = SimTime::from_utime(50'013'300);
  run_until(at_ms(51'000));
  EXPECT_EQ(states_["sub"].front().utime, 50'100'000);
  EXPECT_EQ(states_["sub"].front().position_ned_m[2], 20);
}

TEST_F(VehicleSimNodeTest, AnotherRunStartsFromTheBeginning) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0, 0, 20});
  run_until(at_ms(1500));
  now_ = SimTime();
  node_->restart({now_, now_});
  states_.clear();
  node_->step({now_, at_ms(1500)});
  drain();
  ASSERT_FALSE(states_["sub"].empty());
  EXPECT_EQ(states_["sub"].front().utime, 0);
  EXPECT_EQ(states_["sub"].front().position_ned_m[0], 0);
  EXPECT_EQ(states_["sub"].front().velocity_ned_mps[0], 0);
}

TEST_F(VehicleSimNodeTest, AfterALongHaltOldStatesAreCountedNotPublished) {
  make_node();
  run_until(at_ms(100));
  states_.clear();
  node_->step({at_ms(20'000), at_ms(20'000)});
  drain();
  EXPECT_EQ(states_["sub"].front().utime, 18'000'000);
  EXPECT_EQ(states_["sub"].back().utime, 20'000'000);
  EXPECT_GT(node_->counters().late, 100);
}

TEST_F(VehicleSimNodeTest, AFaultOnTheBusBreaksAndMends) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0.1, 0, 20});
  const auto publish_fault = [&](Fault fault) {
    ear_.publish(bus::channels::kFault.of("sub"), to_fault_message(fault, false));
    drain();
  };
  publish_fault({.from = SimTime(), .kind = FaultKind::kStuckRudder, .angle_rad = -0.05});
  publish_fault({.from = at_ms(500), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kDepth});
  run_until(at_ms(1000));
  EXPECT_NEAR(sensors_["sub"].back().rudder_angle_rad, -0.05, tolerance(1e-4));
  EXPECT_TRUE(sensors_["sub"][2].depth_fresh);
  EXPECT_FALSE(sensors_["sub"].back().depth_fresh);
  publish_fault({.from = SimTime(), .kind = FaultKind::kStuckRudder, .fixed = true});
  command(at_ms(1000), {0.1, 0, 20});
  run_until(at_ms(2000));
  EXPECT_NEAR(sensors_["sub"].back().rudder_angle_rad, 0.1, tolerance(1e-4));
}

TEST_F(VehicleSimNodeTest, FaultsOfTheScenarioArePublishedWhenTheyBeginAndEnd) {
  const Fault leak{
      .from = at_ms(730), .kind = FaultKind::kLeak, .leak_rate_kg_s = 0.1, .leak_volume_m3 = 0.01};
  const Fault dead{.from = at_ms(250), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kDepth};
  config_.faults = {{"sub", leak, SimTime()}, {"sub", dead, at_ms(1500)}};
  make_node();
  std::vector<std::pair<SimTime, vehicle_fault_t>> faults;
  ear_.subscribe<vehicle_fault_t>(bus::channels::kFault.of("sub"),
                                  [&](const vehicle_fault_t& m) { faults.emplace_back(now_, m); });
  run_until(at_ms(3000));
  ASSERT_EQ(faults.size(), 3u);
  const std::int64_t begins_ms[] = {250, 730, 1500};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(faults[i].first, at_ms(begins_ms[i]));
    EXPECT_EQ(faults[i].second.utime, begins_ms[i] * 1000);
    EXPECT_EQ(faults[i].second.session, 77);
    EXPECT_EQ(faults[i].second.sequence, static_cast<std::int64_t>(i));
    EXPECT_TRUE(faults[i].second.from_scenario);
  }
  EXPECT_EQ(faults[1].second.fault_kind, vehicle_fault_t::LEAK);
  EXPECT_TRUE(faults[2].second.fault_fixed);
  EXPECT_EQ(node_->counters().refused, 0);
}

TEST_F(VehicleSimNodeTest, AFaultMarkedAsTheScenariosChangesNothing) {
  make_node();
  run_until(at_ms(100));
  Fault dead{.from = at_ms(200), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kDepth};
  ear_.publish(bus::channels::kFault.of("sub"), to_fault_message(dead, /*from_scenario=*/true));
  run_until(at_ms(1000));
  EXPECT_TRUE(sensors_["sub"].back().depth_fresh);
  ear_.publish(bus::channels::kFault.of("sub"), to_fault_message(dead, /*from_scenario=*/false));
  run_until(at_ms(2000));
  EXPECT_FALSE(sensors_["sub"].back().depth_fresh);
}

TEST_F(VehicleSimNodeTest, AFaultOfTheScenarioHoldsForItsTime) {
  Fault dead{.from = at_ms(400), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kAltimeter};
  config_.faults = {{"sub", dead, at_ms(800)}};
  make_node();
  run_until(at_ms(1000));
  const std::vector<int> measured{0, 0, 2, 2, 0, 0};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(sensors_["sub"][k].altitude_status, measured[k]) << k;
}

TEST_F(VehicleSimNodeTest, ThePublishedBytesAreTheSameForAnyNumberOfThreads) {
  config_.buoyancy_over_weight = 0.97;
  config_.sensors.dvl.period = SimDuration::from_milliseconds(250);
  config_.sensors.dvl.errors = {.noise = 0.01, .bias = 0, .walk = 0.001, .dropout = 0.1};
  config_.sensors.gyro.errors = {.noise = 0.01, .bias = 0, .walk = 0.001, .dropout = 0.1};
  bus::Scenario crowd = scenario_of_two();
  for (int i = 0; i < 150; ++i) {
    crowd.vehicles.push_back({.name = "v" + std::to_string(i),
                              .id = 100 + i,
                              .start_ned_m = {0.5 * i, 0.3 * (i % 7), 20},
                              .heading_rad = 0.5 * i,
                              .speed_mps = 2});
  }
  config_.tethers = {{.vehicle = "v1", .to_vehicle = "v9", .length_m = 3}};
  const auto bytes_with = [&](int threads) {
    config_.threads = threads;
    states_.clear();
    pings_.clear();
    sensors_.clear();
    now_ = SimTime();
    node_ = std::make_unique<VehicleSimNode>(lcm_, bus::NodeIdentity{"vehicle-sim", 77}, crowd, config_,
                                             testing::ridge(21, 0.2));
    run_until(at_ms(5000));
    std::string bytes;
    const auto add = [&](const auto& message) {
      std::vector<char> encoded(static_cast<std::size_t>(message.getEncodedSize()));
      message.encode(encoded.data(), 0, message.getEncodedSize());
      bytes.append(encoded.begin(), encoded.end());
    };
    for (const auto& [name, states] : states_) std::for_each(states.begin(), states.end(), add);
    for (const auto& [name, sensors] : sensors_) std::for_each(sensors.begin(), sensors.end(), add);
    std::for_each(pings_.begin(), pings_.end(), add);
    return bytes;
  };
  const std::string alone = bytes_with(1);
  EXPECT_GT(alone.size(), 1'000'000u);
  EXPECT_TRUE(bytes_with(2) == alone);
  EXPECT_TRUE(bytes_with(4) == alone);
}

TEST_F(VehicleSimNodeTest, TwoRunsInLockstepPublishTheSame) {
  const auto run = [&] {
    states_.clear();
    make_node(testing::ridge(25, 0.5));
    bus::LockstepRunner runner({node_.get()});
    runner.set_listener([&](SimTime, std::string_view channel, std::span<const std::uint8_t> message) {
      ear_.deliver(channel, message);
    });
    runner.run_until(at_ms(500));
    command(at_ms(600), {0.1, 0.2, 25});
    runner.run_until(at_ms(5000));
    return states_["sub"];
  };
  const auto first = run(), second = run();
  ASSERT_EQ(first.size(), 51u);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(first[k].position_ned_m[c], second[k].position_ned_m[c]);
  }
}

}  // namespace
}  // namespace halocline::vehicle_sim
