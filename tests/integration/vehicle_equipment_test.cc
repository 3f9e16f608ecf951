// SPDX-License-Identifier: BSD-3-Clause
// Clocks, batteries and noise of vehicles in a whole run: the scenarios ranging, with some of each,
// ship_crossing and, with all else beside them, front_survey.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "bus/bus.h"
#include "core/frames.h"
#include "runs/analysis/simulation_output.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class VehicleEquipmentTest : public testing::EmbeddedTest {
 protected:
  std::string run_with(const std::vector<std::string>& overrides, const std::string& name = "equipment") {
    return run(load("ranging", overrides), name);
  }
  template <class Message>
  static std::vector<Message> all_of(const std::string& log, const std::string& channel) {
    std::vector<Message> found;
    for (auto& [on, message] : messages_in<Message>(log)) {
      if (on == channel) found.push_back(message);
    }
    return found;
  }
};

// What the ledger says of each packet, and what the battery says of itself.
TEST_F(VehicleEquipmentTest, TheEnergyOfAllCausesIsWhatTheBatteryHasLost) {
  const std::string log = run_with({"scenario.duration_s=90", "vehicle.2.battery.capacity_wh=500"});
  const auto reports = all_of<vehicle_battery_t>(log, "BATTERY.auv-1");
  ASSERT_EQ(reports.size(), 91u);
  const vehicle_battery_t& last = reports.back();
  double transmit_j = 0, receive_j = 0;
  for (const modem_energy_t& use : all_of<modem_energy_t>(log, "MODEM_ENERGY.auv-1")) {
    if (use.utime + 100'000 > last.utime) continue;  // counted a tenth of a second later
    (use.energy_cause == modem_energy_t::TRANSMIT ? transmit_j : receive_j) += use.energy_j;
  }
  EXPECT_GT(transmit_j, 0);
  EXPECT_GT(receive_j, 0);
  EXPECT_NEAR(last.transmit_energy_j, transmit_j, 1e-9 * transmit_j);
  EXPECT_NEAR(last.receive_energy_j, receive_j, 1e-9 * receive_j);
  const double lost_j = last.capacity_j - last.energy_left_j;
  const double hotel_j = 20.2 * 90;
  EXPECT_NEAR(last.hotel_energy_j, hotel_j, 1e-9 * hotel_j);
  EXPECT_NEAR(last.hotel_energy_j + last.shaft_energy_j + transmit_j + receive_j, lost_j, 1e-9 * lost_j);
  EXPECT_GT(last.shaft_energy_j, 0);

  double by_outcomes_j = 0;
  std::set<std::tuple<std::int64_t, std::int64_t, std::int8_t>> counted;
  for (const packet_outcome_t& o : all_of<packet_outcome_t>(log, "OUTCOME")) {
    if (o.source_id == 3 && o.departure_utime + 100'000 <= last.utime &&
        counted.insert({o.send_session, o.packet_sequence, o.packet_kind}).second)
      by_outcomes_j += o.transmit_energy_j;
    if (o.source_id != 3) {
      EXPECT_EQ(o.transmit_energy_j, 0);
    }
  }
  EXPECT_LE(by_outcomes_j, transmit_j * (1 + 1e-9));
  EXPECT_GT(by_outcomes_j, 0.9 * transmit_j);  // but for packets still under way
}

TEST_F(VehicleEquipmentTest, AnEmptyBatteryEndsTheVehicleAndItsModem) {
  // 20 W of hotel and the shaft take 0.2 Wh within 36 s.
  const std::string log = run_with({"scenario.duration_s=60", "vehicle.2.battery.capacity_wh=0.2"});
  const auto faults = all_of<vehicle_fault_t>(log, "FAULT.auv-1");
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].fault_kind, vehicle_fault_t::EMPTY_BATTERY);
  EXPECT_TRUE(all_of<vehicle_battery_t>(log, "BATTERY.auv-1").back().battery_empty);
  const auto receipts = all_of<modem_receipt_t>(log, "RECEIPT.auv-1");
  EXPECT_EQ(receipts.front().receipt_result, modem_receipt_t::ACCEPTED);
  EXPECT_EQ(receipts.back().receipt_result, modem_receipt_t::REFUSED_NO_MODEM);
  const auto states = all_of<vehicle_state_t>(log, "STATE.auv-1");
  const auto speed = [](const vehicle_state_t& s) {
    return std::hypot(s.velocity_ned_mps[0], s.velocity_ned_mps[1]);
  };
  EXPECT_LT(speed(states.back()), 0.7 * speed(states[100]));
}

// Scenario ship_crossing: an offset of 2 ms is 3 m of range, a drift of 2 ppm 2.7 m more by the end.
TEST_F(VehicleEquipmentTest, OneWayRangesToThreeBeaconsTellThePlaceAndTheClock) {
  const std::string log = run(load("ship_crossing", {}), "ship");
  const auto estimates = all_of<position_estimate_t>(log, "ESTIMATE.auv-1");
  ASSERT_EQ(estimates.size(), 901u);
  int far_off = 0;
  for (const position_estimate_t& estimate : estimates) {
    if (estimate.utime < 120'000'000) continue;
    const double at_s = 1e-6 * static_cast<double>(estimate.utime);
    // By the end the random walk has a standard deviation of 0.03 ms.
    const double truth_s = 0.002 + 2e-6 * at_s, walk_s = 1e-4;
    EXPECT_LT(std::abs(estimate.clock_offset_s - truth_s), 4 * estimate.clock_offset_deviation_s + walk_s)
        << at_s;
    far_off += std::hypot(estimate.error_ned_m[0], estimate.error_ned_m[1]) > 1 ? 1 : 0;
  }
  EXPECT_EQ(far_off, 0);
  const position_estimate_t& last = estimates.back();
  EXPECT_LT(last.clock_offset_deviation_s, 2e-4);
  EXPECT_NEAR(last.clock_drift, 2e-6, 4 * last.clock_drift_deviation);
  EXPECT_LT(last.clock_drift_deviation, 3e-7);
}

// Of the packets on the 1400 m between two beacons: while the ship is within 900 m of the receiver, and while
// she is not.
TEST_F(VehicleEquipmentTest, AShipThatCrossesCostsPacketsWhileSheIsNear) {
  constexpr std::int32_t kShip = 5;
  const std::string log = run(load("ship_crossing", {"channel_server.predicted_payload_bytes=1"}), "ship");
  const auto track = all_of<vehicle_state_t>(log, "STATE.ship");
  const auto distance_m = [&](const Vec3& from, std::int64_t utime) {
    const auto at = std::lower_bound(track.begin(), track.end(), utime,
                                     [](const vehicle_state_t& s, std::int64_t t) { return s.utime < t; });
    return (Eigen::Map<const Vec3>(at == track.end() ? track.back().position_ned_m : at->position_ned_m) -
            from)
        .norm();
  };
  // Delivery from west to east and back, by the second.
  std::map<std::pair<std::int64_t, std::int32_t>, double> predicted;
  for (const std::string name : {"west", "east"}) {
    for (const link_table_t& table : all_of<link_table_t>(log, "LINKS." + name)) {
      for (const link_t& row : table.peers)
        predicted[{table.utime, row.receiver_id}] = row.delivery_probability;
    }
  }
  int near = 0, lost_near = 0, far = 0, lost_far = 0, by_ship = 0;
  double expected_near = 0, expected_far = 0;
  for (const packet_outcome_t& o : all_of<packet_outcome_t>(log, "OUTCOME")) {
    EXPECT_NE(o.receiver_id, kShip);
    const bool is_lost = o.outcome == packet_outcome_t::COLLIDED;
    by_ship +=
        is_lost && std::any_of(o.colliders.begin(), o.colliders.end(),
                               [&](const packet_name_t& c) { return c.is_noise && c.source_id == kShip; })
            ? 1
            : 0;
    if (o.source_id > 2 || o.receiver_id > 2) continue;
    const bool is_near = distance_m(Vec3(0, o.receiver_id == 1 ? -700 : 700, 52), o.utime) < 900;
    (is_near ? near : far) += 1;
    (is_near ? lost_near : lost_far) += is_lost ? 1 : 0;
    (is_near ? expected_near : expected_far) +=
        1 - predicted[{o.departure_utime / 1'000'000 * 1'000'000, o.receiver_id}];
  }
  ASSERT_GT(near, 40);
  ASSERT_GT(far, 40);
  EXPECT_GT(by_ship, 20);
  EXPECT_GT(lost_near * far, 3 * lost_far * near);
  EXPECT_NEAR(expected_near, lost_near, 0.15 * near);
  EXPECT_NEAR(expected_far, lost_far, 0.1 * far);
}

TEST_F(VehicleEquipmentTest, WithAllOfItTheOutputIsTheSameWithShardsBlocksAndThreads) {
  const std::vector<std::string> all{"scenario.duration_s=40", "network.interval_s=10", "modem.events=true",
                                     "vehicle.3.battery.capacity_wh=0.5"};
  const auto output = [&](const std::vector<std::string>& more, const std::string& name) {
    std::vector<std::string> overrides = all;
    overrides.insert(overrides.end(), more.begin(), more.end());
    LogReader log(run(load("front_survey", overrides), name));
    const std::string path = log_path(name + "-output");
    EXPECT_GT(write_simulation_output(log, path), 1000);
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string alone = output({}, "alone");
  for (const std::string channel :
       {"MODEM_ENERGY.auv", "MODEM_EVENT.buoy", "BATTERY.auv", "FAULT.auv", "NETWORK_EVENT.buoy"})
    EXPECT_NE(alone.find(channel), std::string::npos) << channel;
  EXPECT_TRUE(
      alone ==
      output({"channel_server.shards=3", "channel_server.threads=2", "vehicle_sim.threads=2"}, "shards"));
  EXPECT_TRUE(alone == output({"vehicle_sim.blocks=3"}, "blocks"));
}

}  // namespace
}  // namespace halocline::clients
