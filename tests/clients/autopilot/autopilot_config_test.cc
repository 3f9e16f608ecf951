#include "clients/autopilot/autopilot_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/scenario.h"
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
