// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/autopilot_node.h"

#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/clients/onboard/autopilot/autopilot_node_fixture.h"

namespace halocline::clients {
namespace {

TEST_F(AutopilotNodeTest, CommandsComeOnTheGridStampedWithIt) {
  publish_state(0);
  step(0);
  EXPECT_EQ(node_.due().sim, at_ms(100));
  step(130);
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[0].utime, 0);
  EXPECT_EQ(commands_[1].utime, 100'000);
  EXPECT_EQ(commands_[1].sequence, 1);
  EXPECT_EQ(commands_[1].session, 11);
  EXPECT_EQ(node_.due().sim, at_ms(200));
}

TEST_F(AutopilotNodeTest, SteersTowardsTheWaypoint) {
  publish_state(0);
  step(0);
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_GT(commands_[0].rudder_rad, 0);       // east lies to starboard
  EXPECT_GT(commands_[0].stern_plane_rad, 0);  // 20 m down
  EXPECT_GT(commands_[0].propeller_rpm, 500);
}

// It passes the waypoint's latitude northwards: what steers is where it is now, not where it was last seen.
TEST_F(AutopilotNodeTest, AStateIsCarriedOnToTheInstantOfTheCommand) {
  publish_state(0, 400);
  step(800);
  vehicle_state_t there{};
  there.utime = 800'000;
  there.vehicle_id = 1;
  there.orientation_wxyz[0] = 1;
  there.position_ned_m[0] = 0.8 * 1.5;
  there.position_ned_m[1] = 400;
  there.velocity_ned_mps[0] = 1.5;
  const auto by_old_state = commands_;
  AutopilotNode other(lcm_, {"autopilot", 11}, one_mission());
  peer_.publish(bus::channels::kState.of("auv-1"), there);
  drain();
  commands_.clear();
  other.step({at_ms(800), at_ms(800)});
  drain();
  ASSERT_EQ(by_old_state.size(), 1u);
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_EQ(bus::encoded(commands_[0]), bus::encoded(by_old_state[0]));
}

TEST_F(AutopilotNodeTest, WithoutAStateThereIsNoCommand) {
  step(0);
  EXPECT_TRUE(commands_.empty());
}

TEST_F(AutopilotNodeTest, StateTooOldIsNotSteeredBy) {
  publish_state(0);
  step(1000);
  EXPECT_EQ(commands_.size(), 1u);
  step(1100);
  EXPECT_EQ(commands_.size(), 1u);
}

TEST_F(AutopilotNodeTest, SpeedThroughTheWaterComesFromTheSensors) {
  publish_state(0);
  step(0);
  publish_sensors(100, 1.0, 500);
  step(100);
  EXPECT_GT(commands_[1].propeller_rpm, commands_[0].propeller_rpm + 100);
}

TEST_F(AutopilotNodeTest, SeabedCloseBelowKeepsTheVehicleUp) {
  publish_state(0);
  publish_sensors(0, 1.5, 1.0);  // least altitude is 3 m
  step(0);
  EXPECT_LT(commands_[0].stern_plane_rad, 0);
}

TEST_F(AutopilotNodeTest, AnotherRunStartsTheMissionAnew) {
  publish_state(0);
  step(0);
  node_.restart({at_ms(0), at_ms(0)});
  step(0);
  EXPECT_EQ(commands_.size(), 1u);  // nothing received in the new run yet
  publish_state(0);
  step(100);
  EXPECT_EQ(commands_.size(), 2u);
}

// A leader at sensors and a follower, both at memq; what they command and send is kept.
class FormationNodeTest : public ::testing::Test {
 protected:
  static AutopilotConfig formation() {
    AutopilotConfig config = one_mission();
    config.vehicles[0].vehicle_id = 1;
    config.vehicles[0].navigate_by = NavigateBy::kSensors;
    config.vehicles[0].start_ned_m = {30, 40, 0};
    config.vehicles[0].broadcast.period = SimDuration::from_seconds(8);
    config.vehicles[1].vehicle_id = 2;
    config.vehicles[1].behaviours = {{.kind = BehaviourKind::kFollow}};
    config.vehicles[1].behaviours[0].formation.leader = "auv-1";
    return config;
  }
  FormationNodeTest() {
    peer_.subscribe<modem_send_t>(bus::channels::kSend,
                                  [this](std::string_view vehicle, const modem_send_t& packet) {
                                    EXPECT_EQ(vehicle, "auv-1");
                                    sent_.push_back(packet);
                                  });
    peer_.subscribe<vehicle_command_t>(bus::channels::kCommand.of("auv-1"),
                                       [this](const vehicle_command_t& m) { leader_.push_back(m); });
    peer_.subscribe<vehicle_command_t>(bus::channels::kCommand.of("auv-2"),
                                       [this](const vehicle_command_t& m) { follower_.push_back(m); });
  }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  // The leader's own sensors: north at 2 m/s, 20 m deep.
  void publish_leader(std::int64_t ms) {
    vehicle_sensors_t sensors{};
    sensors.utime = ms * 1000;
    sensors.depth_m = 20;
    sensors.water_speed_mps = 2;
    sensors.altitude_status = vehicle_sensors_t::ALTITUDE_NO_BOTTOM;
    peer_.publish(bus::channels::kSensors.of("auv-1"), sensors);
    drain();
  }
  void step(std::int64_t ms) {
    node_.step({at_ms(ms), at_ms(ms)});
    drain();
  }

  lcm::LCM lcm_{"memq://"};
  AutopilotNode node_{lcm_, {"autopilot", 11}, formation()};
  bus::Bus peer_{lcm_, {"peer", 1}};
  std::vector<modem_send_t> sent_;
  std::vector<vehicle_command_t> leader_, follower_;
};

TEST_F(FormationNodeTest, AFollowerWithoutAReportWaitsForItsLeader) {
  std::vector<autopilot_status_t> reports;
  peer_.subscribe<autopilot_status_t>(bus::channels::kAutopilot.of("auv-2"),
                                      [&](const autopilot_status_t& m) { reports.push_back(m); });
  vehicle_state_t state{};
  state.vehicle_id = 2;
  state.orientation_wxyz[0] = 1;
  peer_.publish(bus::channels::kState.of("auv-2"), state);
  drain();
  step(0);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].autopilot_activity, autopilot_status_t::WAITING_FOR_LEADER);
}

TEST_F(FormationNodeTest, BySensorsNoStateIsNeeded) {
  publish_leader(0);
  step(0);
  EXPECT_EQ(leader_.size(), 1u);
}

TEST_F(FormationNodeTest, LeaderReportsItsReckonedPosition) {
  for (int i = 0; i <= 40; ++i) {
    publish_leader(200 * i);
    step(200 * i);
  }
  // No receipt comes, so the first is repeated beside the second.
  const auto second =
      std::find_if(sent_.begin(), sent_.end(), [](const auto& m) { return m.packet_sequence == 1; });
  ASSERT_NE(second, sent_.end());
  const modem_send_t& packet = *second;
  EXPECT_EQ(packet.utime, 8'000'000);
  EXPECT_EQ(packet.destination_id, 0);
  const auto report = decode_report(packet.payload, 9);
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->position_ned_m.x(), 30 + 16, 0.06);  // rounded to 0.1 m
  EXPECT_NEAR(report->position_ned_m.y(), 40, 0.06);
  EXPECT_NEAR(report->time_s, 8, 1e-9);
}

TEST_F(FormationNodeTest, LocaliserReplacesTheReckonedPlace) {
  publish_leader(0);
  position_estimate_t estimate{};
  estimate.vehicle_id = 1;
  estimate.likelihood = 1;
  for (const int axis : {0, 4, 8}) estimate.covariance_ned_m2[axis] = 1;
  estimate.estimate_status = position_estimate_t::AMBIGUOUS;
  estimate.position_ned_m[0] = 500;
  peer_.publish(bus::channels::kEstimate.of("auv-1"), estimate);  // not sure: left out
  estimate.estimate_status = position_estimate_t::UNIQUE;
  estimate.position_ned_m[0] = 100;
  estimate.position_ned_m[1] = -70;
  peer_.publish(bus::channels::kEstimate.of("auv-1"), estimate);
  drain();
  step(0);
  ASSERT_FALSE(sent_.empty());
  const auto report = decode_report(sent_.front().payload, 1);
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->position_ned_m.x(), 100, 0.06);
  EXPECT_NEAR(report->position_ned_m.y(), -70, 0.06);
}

TEST_F(FormationNodeTest, ADopplerLogGivesTheVelocityOverGroundWhileItIsFresh) {
  vehicle_dvl_t ping{};
  ping.ground_velocity_valid = 1;
  ping.ground_velocity_body_mps[0] = 2;
  ping.ground_velocity_body_mps[1] = 0.5;  // a current towards starboard, east
  for (int i = 0; i <= 40; ++i) {
    ping.utime = 200'000 * i;
    if (i <= 10) peer_.publish(bus::channels::kDvl.of("auv-1"), ping);
    publish_leader(200 * i);
    step(200 * i);
  }
  const auto second =
      std::find_if(sent_.begin(), sent_.end(), [](const auto& m) { return m.packet_sequence == 1; });
  ASSERT_NE(second, sent_.end());
  const auto report = decode_report(second->payload, 9);
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->position_ned_m.x(), 30 + 16, 0.06);
  // 2 s of pings and 1.5 s for which the last is used; half a sample on the way back to the log.
  EXPECT_NEAR(report->position_ned_m.y(), 40 + 0.5 * 3.5, 0.06 + 0.05);
}

TEST_F(FormationNodeTest, ASatelliteFixMovesTheReckonedPosition) {
  publish_leader(0);
  vehicle_gps_t fix{};
  fix.fix_north_m = 130;
  fix.fix_east_m = 40;
  fix.fix_deviation_m = 1;  // as much as the start's
  peer_.publish(bus::channels::kGps.of("auv-1"), fix);
  drain();
  step(0);
  ASSERT_FALSE(sent_.empty());
  EXPECT_NEAR(decode_report(sent_.front().payload, 1)->position_ned_m.x(), 80, 0.06);
}

TEST_F(FormationNodeTest, FollowerUsesReportsOfItsLeaderFromReceiveAlone) {
  vehicle_state_t state{};
  state.vehicle_id = 2;
  state.orientation_wxyz[0] = 1;
  state.velocity_ned_mps[0] = 1.5;
  peer_.publish(bus::channels::kState.of("auv-2"), state);
  modem_receive_t packet{};
  packet.utime = 100'000;
  packet.source_id = 1;
  packet.receiver_id = 2;
  packet.payload = encode_report({{-30, 300, 20}, 0, 1.5, 0});  // its place lies east of the follower
  packet.payload_size = static_cast<std::int32_t>(packet.payload.size());
  peer_.publish(bus::channels::kReceive.of("auv-2"), packet);
  drain();
  step(100);
  ASSERT_EQ(follower_.size(), 1u);
  EXPECT_GT(follower_[0].rudder_rad, 0.1);
}

TEST(AutopilotNode, LeaderThatDoesNotBroadcastIsRefused) {
  lcm::LCM lcm("memq://");
  AutopilotConfig config = one_mission();
  config.vehicles[1].behaviours = {{.kind = BehaviourKind::kFollow}};
  config.vehicles[1].behaviours[0].formation.leader = "auv-1";
  EXPECT_THROW(AutopilotNode(lcm, {"autopilot", 1}, config), InvalidArgument);
}

TEST(AutopilotNode, UnknownOnlyVehicleIsRefused) {
  lcm::LCM lcm("memq://");
  AutopilotConfig config = one_mission();
  config.only_vehicle = "auv-2";
  EXPECT_THROW(AutopilotNode(lcm, {"autopilot", 1}, config), InvalidArgument);
}

// Behind its first waypoint, with integrals that have grown: steers as the one that was not killed.
TEST(KilledAutopilot, GoesOnWithItsPlanAndItsNumbers) {
  lcm::LCM lcm("memq://");
  bus::Bus peer(lcm, {"peer", 1});
  std::vector<vehicle_command_t> commands;
  peer.subscribe<vehicle_command_t>(bus::channels::kCommand.of("auv-1"),
                                    [&](const vehicle_command_t& m) { commands.push_back(m); });
  const auto publish_state = [&](int k) {
    vehicle_state_t state{};
    state.utime = k * 100'000;
    state.vehicle_id = 1;
    state.orientation_wxyz[0] = 1;
    state.position_ned_m[1] = k;
    peer.publish(bus::channels::kState.of("auv-1"), state);
    while (lcm.handleTimeout(0) > 0) {
    }
  };
  AutopilotConfig config = one_mission();
  config.vehicles[0].mission.waypoints = {{0, 40, 20}, {500, 40, 20}};
  const bus::testing::JournalFiles files;
  AutopilotNode whole(lcm, {"autopilot", 11}, config);
  whole.keep_state_in(files.open());
  for (int k = 0; k <= 50; ++k) {
    publish_state(k);
    whole.step({at_ms(100 * k), at_ms(100 * k)});
  }
  AutopilotNode resumed(lcm, {"autopilot", 11}, config);
  resumed.keep_state_in(files.open());
  publish_state(51);
  commands.clear();
  whole.step({at_ms(5100), at_ms(5100)});
  resumed.step({at_ms(5100), at_ms(0)});
  while (lcm.handleTimeout(0) > 0) {
  }
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[0].sequence, 51);
  EXPECT_LT(commands[0].rudder_rad, 0) << "not back to the leg to the second waypoint";
  EXPECT_EQ(bus::encoded(commands[1]), bus::encoded(commands[0]));
}

}  // namespace
}  // namespace halocline::clients
