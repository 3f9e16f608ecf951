// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/autopilot_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/config/scenario.h"
#include "core/units.h"

namespace halocline::clients {
namespace {

AutopilotConfig read(const std::string& text) {
  AutopilotConfig config;
  bus::Scenario scenario;
  auto file = bus::ConfigFile::parse(text, "test.toml");
  file.read([&](bus::ConfigVisitor& v) {
    visit(v, scenario);
    visit(v, config);
  });
  file.check(/*whole_file=*/true);
  return config;
}

constexpr const char* kMission = R"(
[[vehicle]]
name = "auv-1"
id = 4
[vehicle.mission]
waypoints = [[100.0, 0.0, 20.0], [100.0, 50.0, 25.0]]
speed_mps = 1.8
at_end = "loop"
[vehicle.mission.gains]
max_pitch_deg = 30
[[vehicle]]
name = "auv-2"
id = 5
)";

TEST(AutopilotConfigFile, MissionIsRead) {
  const AutopilotConfig config = read(kMission);
  ASSERT_EQ(config.vehicles.size(), 2u);
  EXPECT_EQ(config.vehicles[0].vehicle, "auv-1");
  EXPECT_EQ(config.vehicles[0].vehicle_id, 4);
  ASSERT_EQ(config.vehicles[0].mission.waypoints.size(), 2u);
  EXPECT_EQ(config.vehicles[0].mission.waypoints[1], Vec3(100, 50, 25));
  EXPECT_EQ(config.vehicles[0].mission.at_end, AtEnd::kLoop);
  EXPECT_DOUBLE_EQ(config.vehicles[0].gains.max_pitch_rad, to_radians(30));
}

TEST(AutopilotConfigFile, VehicleWithoutAMissionHasNoWaypoints) {
  EXPECT_TRUE(read(kMission).vehicles[1].mission.waypoints.empty());
}

constexpr const char* kFormation = R"(
[[vehicle]]
name = "lead"
id = 4
[vehicle.mission]
waypoints = [[100.0, 0.0, 20.0]]
[vehicle.mission.broadcast]
period_s = 8
[[vehicle]]
name = "wing"
id = 5
start_ned_m = [1.0, 2.0, 3.0]
[vehicle.mission]
navigate_by = "sensors"
[[vehicle.mission.behaviour]]
kind = "survey"
altitude_m = 5
heading_deg = 90
[[vehicle.mission.behaviour]]
kind = "follow"
[vehicle.mission.behaviour.formation]
leader = "lead"
across_m = 40
)";

TEST(AutopilotConfigFile, BehavioursAreReadInTheirOrder) {
  const PilotConfig wing = read(kFormation).vehicles.at(1);
  EXPECT_TRUE(wing.is_piloted());
  ASSERT_EQ(wing.behaviours.size(), 2u);
  EXPECT_EQ(wing.behaviours[0].kind, BehaviourKind::kSurvey);
  EXPECT_EQ(wing.behaviours[0].altitude_m, 5);
  EXPECT_DOUBLE_EQ(wing.behaviours[0].heading_rad, to_radians(90));
  EXPECT_EQ(wing.behaviours[1].formation.leader, "lead");
  EXPECT_EQ(wing.behaviours[1].formation.across_m, 40);
  EXPECT_EQ(wing.navigate_by, NavigateBy::kSensors);
  EXPECT_EQ(wing.start_ned_m, Vec3(1, 2, 3));
}

void expect_error(std::string text, const std::string& from, const std::string& to,
                  const std::string& message) {
  text.replace(text.find(from), from.size(), to);
  try {
    read(text);
    ADD_FAILURE() << "no error";
  } catch (const bus::ConfigErrors& errors) {
    EXPECT_THAT(errors.what(), ::testing::HasSubstr("test.toml:"));
    EXPECT_THAT(errors.what(), ::testing::HasSubstr(message));
  }
}

TEST(AutopilotConfigFile, LeaderThatDoesNotBroadcastIsAnError) {
  expect_error(kFormation, "leader = \"lead\"", "leader = \"wing\"", "a leader that broadcasts");
  expect_error(kFormation, "period_s = 8", "start_s = 8", "given is 'lead'");
}

TEST(AutopilotConfigFile, UnknownBehaviourIsRefusedWithAListOfTheAllowedOnes) {
  expect_error(kFormation, "\"survey\"", "\"fly\"", "waypoints, heading, loiter, survey, follow");
}

TEST(AutopilotConfigFile, BehaviourOfWaypointsNeedsThem) {
  expect_error(kFormation, "\"survey\"", "\"waypoints\"", "behaviour");
}

TEST(AutopilotConfigFile, WaypointsBesideBehavioursAreAnError) {
  expect_error(kFormation, "navigate_by", "waypoints = [[1.0, 2.0, 3.0]]\nnavigate_by",
               "give them to a behaviour");
}

TEST(AutopilotConfigFile, ImpossibleValuesAreAllNamed) {
  const std::string text = R"(
[[vehicle]]
name = "auv-1"
id = 1
[vehicle.mission]
speed_mps = -1
at_end = "fly"
waypoint = []
)";
  try {
    read(text);
    FAIL() << "no error";
  } catch (const bus::ConfigErrors& errors) {
    EXPECT_THAT(errors.lines(), ::testing::SizeIs(3));
    EXPECT_THAT(errors.what(), ::testing::HasSubstr("speed_mps"));
    EXPECT_THAT(errors.what(), ::testing::HasSubstr("loop, hold, stop"));
    EXPECT_THAT(errors.what(), ::testing::HasSubstr("mission.waypoint is unknown"));
  }
}

}  // namespace
}  // namespace halocline::clients
