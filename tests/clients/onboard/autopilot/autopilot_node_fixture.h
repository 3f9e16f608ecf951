// SPDX-License-Identifier: BSD-3-Clause
// The autopilot's node on memq, with one vehicle that has a mission, and what it published.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/autopilot_node.h"
#include "core/sim_time.h"
#include "tests/support/at_ms.h"

namespace halocline::clients {

using halocline::testing::at_ms;

inline AutopilotConfig one_mission() {
  AutopilotConfig config;
  config.vehicles.resize(2);
  config.vehicles[0].vehicle = "auv-1";
  config.vehicles[0].mission.waypoints = {{0, 500, 20}};  // east of the origin
  config.vehicles[1].vehicle = "auv-2";
  return config;
}

class AutopilotNodeTest : public ::testing::Test {
 protected:
  AutopilotNodeTest() {
    peer_.subscribe<vehicle_command_t>(bus::channels::kCommand,
                                       [this](std::string_view vehicle, const vehicle_command_t& command) {
                                         EXPECT_EQ(vehicle, "auv-1");
                                         commands_.push_back(command);
                                       });
    peer_.subscribe<vehicle_plan_t>(bus::channels::kPlan.of("auv-1"),
                                    [this](const vehicle_plan_t& plan) { plans_.push_back(plan); });
    peer_.subscribe<autopilot_status_t>(
        bus::channels::kAutopilot.of("auv-1"),
        [this](const autopilot_status_t& status) { reports_.push_back(status); });
  }
  // A vehicle at the origin that heads north.
  void publish_state(std::int64_t ms, double east_m = 0) {
    vehicle_state_t state{};
    state.utime = ms * 1000;
    state.vehicle_id = 1;
    state.orientation_wxyz[0] = 1;
    state.position_ned_m[1] = east_m;
    state.velocity_ned_mps[0] = 1.5;
    peer_.publish(bus::channels::kState.of("auv-1"), state);
    drain();
  }
  void publish_sensors(std::int64_t ms, double speed_mps, double altitude_m) {
    vehicle_sensors_t sensors{};
    sensors.utime = ms * 1000;
    sensors.water_speed_mps = speed_mps;
    sensors.altitude_status = vehicle_sensors_t::ALTITUDE_MEASURED;
    sensors.altitude_m = altitude_m;
    peer_.publish(bus::channels::kSensors.of("auv-1"), sensors);
    drain();
  }
  void step(std::int64_t ms) {
    node_.step({at_ms(ms), at_ms(ms)});
    drain();
  }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }

  lcm::LCM lcm_{"memq://"};
  AutopilotNode node_{lcm_, {"autopilot", 11}, one_mission()};
  bus::Bus peer_{lcm_, {"peer", 1}};
  std::vector<vehicle_command_t> commands_;
  std::vector<vehicle_plan_t> plans_;
  std::vector<autopilot_status_t> reports_;
};

}  // namespace halocline::clients
