#include "clients/autopilot/autopilot_node.h"

#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline::clients {
namespace {

SimTime at_ms(std::int64_t ms) { return SimTime() + SimDuration::from_milliseconds(ms); }

AutopilotConfig one_mission() {
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
    ear_.subscribe<vehicle_command_t>(bus::channels::kCommand,
                                      [this](std::string_view vehicle, const vehicle_command_t& command) {
                                        EXPECT_EQ(vehicle, "auv-1");
                                        commands_.push_back(command);
                                      });
  }
  // A vehicle at the origin that heads north.
  void publish_state(std::int64_t ms) {
    vehicle_state_t state{};
    state.utime = ms * 1000;
    state.vehicle_id = 1;
    state.orientation_wxyz[0] = 1;
    state.velocity_ned_mps[0] = 1.5;
    ear_.publish(bus::channels::kState.of("auv-1"), state);
    drain();
  }
  void publish_sensors(std::int64_t ms, double speed_mps, double altitude_m) {
    vehicle_sensors_t sensors{};
    sensors.utime = ms * 1000;
    sensors.water_speed_mps = speed_mps;
    sensors.altitude_status = vehicle_sensors_t::ALTITUDE_MEASURED;
    sensors.altitude_m = altitude_m;
    ear_.publish(bus::channels::kSensors.of("auv-1"), sensors);
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
  bus::Bus ear_{lcm_, {"ear", 1}};
  std::vector<vehicle_command_t> commands_;
};

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
  EXPECT_EQ(commands_.size(), 1u);  // nothing heard of the new run yet
  publish_state(0);
  step(100);
  EXPECT_EQ(commands_.size(), 2u);
}

TEST(AutopilotNode, UnknownOnlyVehicleIsRefused) {
  lcm::LCM lcm("memq://");
  AutopilotConfig config = one_mission();
  config.only_vehicle = "auv-2";
  EXPECT_THROW(AutopilotNode(lcm, {"autopilot", 1}, config), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
