#include "vehicle_sim/vehicle_sim_config.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::vehicle_sim {
namespace {

using bus::ConfigErrors;
using bus::ConfigFile;
using bus::ConfigVisitor;
using halocline::testing::tolerance;
using ::testing::HasSubstr;

struct Read {
  bus::Scenario scenario;
  VehicleSimConfig config;
};

Read read(const std::string& text) {
  Read r;
  ConfigFile file = ConfigFile::parse(text, "test.toml");
  file.read([&](ConfigVisitor& v) { visit(v, r.scenario); });
  file.read([&](ConfigVisitor& v) { visit(v, r.config); });
  file.check(/*whole_file=*/true);
  return r;
}

std::string errors_of(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigErrors& errors) {
    return errors.what();
  }
  return "";
}

TEST(VehicleSimConfig, AnEmptyFileGivesTheDefaults) {
  const Read r = read("");
  EXPECT_EQ(r.config.step, SimDuration::from_milliseconds(10));
  EXPECT_EQ(r.config.state_period, SimDuration::from_milliseconds(100));
  EXPECT_TRUE(members_of(r.scenario, r.config).empty());
}

TEST(VehicleSimConfig, ValuesAreReadIntoSiUnits) {
  const Read r = read(R"([vehicle_sim]
step_s = 0.005
state_rate_hz = 20
sensor_rate_hz = 4
command_timeout_s = 3
current_ned_mps = [0.1, 0.2, 0.0]
current_treatment = "upstream"
[vehicle_sim.current]
depth_rows = [[0, 0.5, 0], [50, 0, 0.1]]
tide_amplitude_mps = 0.4
tide_toward_deg = 90
random_deviation_mps = 0.1
[vehicle_sim.waves]
sea = "jonswap"
height_m = 1.5
)");
  EXPECT_EQ(r.config.step, SimDuration::from_milliseconds(5));
  EXPECT_EQ(r.config.state_period, SimDuration::from_milliseconds(50));
  EXPECT_EQ(r.config.sensor_period, SimDuration::from_milliseconds(250));
  EXPECT_EQ(r.config.current.uniform_ned_mps, Vec3(0.1, 0.2, 0));
  EXPECT_EQ(r.config.current_treatment, TreatmentChoice::kUpstream);
  ASSERT_EQ(r.config.current.by_depth.size(), 2u);
  EXPECT_EQ(r.config.current.by_depth[1].east_mps, 0.1);
  EXPECT_EQ(r.config.current.tide.amplitude_mps, 0.4);
  EXPECT_EQ(r.config.current.tide.toward_rad, to_radians(90));
  EXPECT_EQ(r.config.current.random.deviation_mps, 0.1);
  EXPECT_EQ(r.config.waves.kind, SeaKind::kJonswap);
  EXPECT_EQ(r.config.waves.height_m, 1.5);
}

TEST(VehicleSimConfig, EverythingWrongIsSaidAtOnce) {
  const std::string errors = errors_of(R"([vehicle_sim]
step_s = 0.5
state_rate_hz = 0
curent_ned_mps = [0, 0, 0]
[[vehicle]]
name = "one"
id = 1
model = "remus600"
)");
  EXPECT_THAT(errors, HasSubstr("test.toml:2"));
  EXPECT_THAT(errors, HasSubstr("state_rate_hz"));
  EXPECT_THAT(errors, HasSubstr("curent_ned_mps"));
  EXPECT_THAT(errors, HasSubstr("remus100-pvs"));
}

TEST(VehicleSimConfig, DepthRowsMustRise) {
  EXPECT_THAT(errors_of("[vehicle_sim.current]\ndepth_rows = [[5, 0, 0], [5, 1, 0]]\n"),
              HasSubstr("test.toml:2"));
  EXPECT_THAT(errors_of("[vehicle_sim.current]\ndepth_rows = [[5, 20, 0]]\n"), HasSubstr("depth_rows"));
}

TEST(VehicleSimConfig, AVehicleMayBeABuiltInModelOrAFile) {
  Read r = read(R"([[vehicle]]
name = "a"
id = 1
[[vehicle]]
name = "b"
id = 2
model = "hover"
[[vehicle]]
name = "c"
id = 3
model = "vehicles/remus100-pvs.toml"
)");
  r.config.model_folder = HALOCLINE_SOURCE_DIR;
  const auto members = members_of(r.scenario, r.config);
  EXPECT_EQ(members[0].model->name(), "torpedo");
  EXPECT_EQ(members[1].model->name(), "hover");
  EXPECT_EQ(members[2].model->name(), "remus100-pvs");
  r.config.model_folder = "/nowhere";
  EXPECT_THROW(members_of(r.scenario, r.config), bus::ConfigErrors);
}

TEST(VehicleSimConfig, OnlyOurVehiclesBecomeMembers) {
  const Read r = read(R"([vehicle_sim]
current_ned_mps = [0.5, 0.0, 0.0]
[[vehicle]]
name = "mover"
id = 1
start_ned_m = [1, 2, 3]
heading_deg = 90
speed_mps = 2
[[vehicle]]
name = "buoy"
id = 2
model = "fixed"
[[vehicle]]
name = "guest"
id = 3
model = "external"
)");
  const auto members = members_of(r.scenario, r.config);
  ASSERT_EQ(members.size(), 2u);
  EXPECT_EQ(members[0].name, "mover");
  EXPECT_EQ(members[0].start.position_ned_m, Vec3(1, 2, 3));
  EXPECT_NEAR(to_euler(members[0].start.orientation).yaw, to_radians(90), tolerance(1e-12));
  const Vec3 over_ground = to_kinematic_state(members[0].start).velocity_ned_mps;
  EXPECT_LT((over_ground - Vec3(0.5, 2, 0)).norm(),
            tolerance(1e-12));  // 2 m/s east through water that goes north
  EXPECT_EQ(members[1].model, nullptr);
  EXPECT_EQ(members[1].start.velocity_body.norm(), 0);
}

const char* const kTug = R"([[vehicle]]
name = "tug"
id = 1
[[vehicle]]
name = "post"
id = 2
model = "fixed"
start_ned_m = [5.0, 0.0, 20.0]
[[tether]]
length_m = 20
)";

TEST(VehicleSimConfig, ATetherTiesVehiclesByName) {
  const Read r =
      read(std::string(kTug) + "vehicle = \"tug\"\nto_vehicle = \"post\"\nattached_at_m = [-0.8, 0, 0]\n");
  const FleetSettings settings = settings_of(r.scenario, r.config);
  ASSERT_EQ(settings.tethers.size(), 1u);
  EXPECT_EQ(settings.tethers[0].member, 0u);
  EXPECT_EQ(settings.tethers[0].to_member, 1u);
  EXPECT_EQ(settings.tethers[0].attached_at_m, Vec3(-0.8, 0, 0));
  EXPECT_EQ(settings.tethers[0].length_m, 20);
}

TEST(VehicleSimConfig, ATetherToNobodyIsRefused) {
  for (const char* wrong :
       {"vehicle = \"nobody\"", "vehicle = \"post\"", "vehicle = \"tug\"\nto_vehicle = \"nobody\"",
        "vehicle = \"tug\"\nto_vehicle = \"tug\""}) {
    const Read r = read(kTug + std::string(wrong) + "\n");
    EXPECT_THROW(settings_of(r.scenario, r.config), InvalidArgument) << wrong;
  }
}

// The scenario that is shipped, without pilots: the tug goes straight on.
TEST(VehicleSimConfig, InTheScenarioTowTheBodyFollowsOnItsRope) {
  Read r;
  ConfigFile file = ConfigFile::load(HALOCLINE_TEST_DATA "/../../scenarios/tow.toml");
  file.read([&](ConfigVisitor& v) { visit(v, r.scenario); });
  file.read([&](ConfigVisitor& v) { visit(v, r.config); });
  file.check(/*whole_file=*/false);
  Fleet fleet(settings_of(r.scenario, r.config), members_of(r.scenario, r.config), nullptr, SimTime());
  double longest = 0;
  for (int tenth = 0; tenth < 600; ++tenth) {
    const SimTime now = SimTime::from_utime(tenth * 100'000);
    fleet.command(0, {now, {0, 0, 20}});
    fleet.advance(now);
    longest = std::max(longest, fleet.tether_distance_m(0));
  }
  EXPECT_LT(longest, 20 + tolerance(0.01));
  EXPECT_GT(longest, 20 - tolerance(0.01));
  EXPECT_GT(fleet.tether_pull_n(0), 1);
}

TEST(VehicleSimConfig, TheEffectiveConfigurationReadsBackAsItself) {
  Read r = read(
      "[vehicle_sim]\nstate_rate_hz = 8\nbuoyancy_over_weight = 1.02\n[[vehicle]]\nname = \"a\"\nid = 1\n");
  const std::string text = bus::to_toml(
      [&](ConfigVisitor& v) {
        visit(v, r.scenario);
        visit(v, r.config);
      },
      true);
  const Read again = read(text);
  EXPECT_EQ(again.config.state_period, r.config.state_period);
  EXPECT_EQ(again.config.buoyancy_over_weight, 1.02);
  EXPECT_EQ(again.scenario.vehicles.size(), 1u);
}

}  // namespace
}  // namespace halocline::vehicle_sim
