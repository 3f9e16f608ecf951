// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/vehicle_sim_config.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/moving_ocean.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {
namespace {

using bus::ConfigErrors;
using bus::ConfigFile;
using bus::ConfigVisitor;
using halocline::testing::tolerance;
using ::testing::AllOf;
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
  ASSERT_EQ(r.config.current.by_depth.size(), 2u);
  EXPECT_EQ(r.config.current.by_depth[1].east_mps, 0.1);
  EXPECT_EQ(r.config.current.tide.amplitude_mps, 0.4);
  EXPECT_EQ(r.config.current.tide.toward_rad, to_radians(90));
  EXPECT_EQ(r.config.current.random.deviation_mps, 0.1);
  EXPECT_EQ(r.config.waves.kind, SeaKind::kJonswap);
  EXPECT_EQ(r.config.waves.height_m, 1.5);
}

TEST(VehicleSimConfig, AllErrorsAreReportedAtOnce) {
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
model = ")" HALOCLINE_SOURCE_DIR R"(/models/vehicles/remus100-pvs.toml"
)");
  const auto members = members_of(r.scenario, r.config);
  EXPECT_EQ(members[0].model->name(), "torpedo");
  EXPECT_EQ(members[1].model->name(), "hover");
  EXPECT_EQ(members[2].model->name(), "remus100-pvs");
  EXPECT_THAT(errors_of("[[vehicle]]\nname = \"a\"\nid = 1\nmodel = \"nowhere/mine.toml\"\n"),
              AllOf(HasSubstr("test.toml:4"), HasSubstr("nowhere/mine.toml")));
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

TEST(VehicleSimConfig, ATetherToAnUnknownVehicleIsRefused) {
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
    EXPECT_EQ(fleet.command(0, {now, {0, 0, 20}}), CommandVerdict::kTaken);
    fleet.advance(now);
    longest = std::max(longest, fleet.tether_distance_m(0));
  }
  EXPECT_LT(longest, 20 + tolerance(0.01));
  EXPECT_GT(longest, 20 - tolerance(0.01));
  EXPECT_GT(fleet.tether_pull_n(0), 1);
}

constexpr const char* kWithSensors = R"(
[vehicle_sim]
state_rate_hz = 8
buoyancy_over_weight = 1.02
threads = 2
[sensors.depth]
noise_m = 0.05
[sensors.compass]
noise_deg = 0.5
bias_deg = -2
[sensors.dvl]
rate_hz = 4
noise_mps = 0.004
dropout_probability = 0.01
beam_angle_deg = 20
[[vehicle]]
name = "a"
id = 1
[vehicle.sensors.compass]
bias_deg = 1
[vehicle.sensors.usbl]
fitted = true
noise_deg = 0.3
[[vehicle]]
name = "b"
id = 2
[[fault]]
vehicle = "b"
kind = "stuck-rudder"
at_s = 10
until_s = 20
angle_deg = 5
[[fault]]
vehicle = "b"
kind = "dead-sensor"
sensor = "gyro"
)";

TEST(VehicleSimConfig, SensorsAreThoseOfAllUnlessAVehicleHasItsOwn) {
  const Read r = read(kWithSensors);
  const auto stations = stations_of(r.scenario, members_of(r.scenario, r.config), r.config);
  ASSERT_EQ(stations.size(), 2u);
  EXPECT_EQ(stations[1].id, 2);
  const SensorSettings &own = stations[0].settings, &common = stations[1].settings;
  EXPECT_NEAR(common.compass.errors.bias, to_radians(-2), tolerance(1e-12));
  EXPECT_NEAR(own.compass.errors.bias, to_radians(1), tolerance(1e-12));
  EXPECT_NEAR(own.compass.errors.noise, to_radians(0.5), tolerance(1e-12));  // where it does not differ
  EXPECT_EQ(own.depth.errors.noise, 0.05);
  EXPECT_EQ(own.dvl.period, SimDuration::from_milliseconds(250));
  EXPECT_NEAR(own.dvl.beam_angle_rad, to_radians(20), tolerance(1e-12));
  EXPECT_TRUE(own.usbl.fitted);
  EXPECT_FALSE(common.usbl.fitted);
  EXPECT_EQ(common.gps.period, SimDuration());  // none
}

TEST(VehicleSimConfig, SensorsOfTheVehicleComeBeforeTheScenariosAndThoseBeforeTheModelFiles) {
  const std::string path = ::testing::TempDir() + "/fitted.toml";
  std::ofstream(path) << "based_on = \"torpedo\"\n[sensors.dvl]\nrate_hz = 2\nnoise_mps = 0.1\nrange_m = 33\n"
                         "[sensors.gps]\nrate_hz = 1\n";
  const Read r =
      read("[sensors.dvl]\nrate_hz = 4\nnoise_mps = 0.2\n[[vehicle]]\nname = \"a\"\nid = 1\nmodel = \"" +
           path + "\"\n[vehicle.sensors.dvl]\nrate_hz = 5\n[[vehicle]]\nname = \"b\"\nid = 2\n");
  const auto stations = stations_of(r.scenario, members_of(r.scenario, r.config), r.config);
  const SensorSettings &fitted = stations[0].settings, &plain = stations[1].settings;
  EXPECT_EQ(fitted.dvl.period, SimDuration::from_milliseconds(200));  // the vehicle's
  EXPECT_EQ(fitted.dvl.errors.noise, 0.2);                            // the scenario's
  EXPECT_EQ(fitted.dvl.range_m, 33);                                  // the model's
  EXPECT_EQ(fitted.gps.period, SimDuration::from_milliseconds(1000));
  EXPECT_EQ(plain.dvl.period, SimDuration::from_milliseconds(250));
  EXPECT_EQ(plain.gps.period, SimDuration());  // none
  std::filesystem::remove(path);
}

TEST(VehicleSimConfig, AFaultHasItsTimesAndItsEnd) {
  const Read r = read(kWithSensors);
  const auto faults = faults_of(members_of(r.scenario, r.config), r.config);
  ASSERT_EQ(faults.size(), 3u);
  for (const auto& [member, fault] : faults) EXPECT_EQ(member, 1u);
  EXPECT_EQ(faults[0].second.from, SimTime::from_seconds(10));
  EXPECT_NEAR(faults[0].second.angle_rad.value(), to_radians(5), tolerance(1e-12));
  EXPECT_TRUE(faults[1].second.fixed);
  EXPECT_EQ(faults[1].second.from, SimTime::from_seconds(20));
  EXPECT_EQ(faults[2].second.sensor, SensorKind::kGyro);
  EXPECT_EQ(faults[2].second.angle_rad, std::nullopt);
}

TEST(VehicleSimConfig, ImpossibleSensorsAndFaultsAreReportedWithLineAndRange) {
  const std::string errors = errors_of(
      "[sensors.dvl]\nrate_hz = -1\nbeam_angle_deg = 90\nnoise = 1\n[sensors.sonar]\nrays = 600\n"
      "[sensors.gps]\ndropout_probability = 1.5\n[sensors.echo]\nrate_hz = 1\n[[fault]]\nvehicle = \"a\"\n"
      "kind = \"fire\"\nat_s = 9\nuntil_s = 5\nsensor = \"nose\"\n");
  EXPECT_THAT(errors, HasSubstr("test.toml:2: sensors.dvl.rate_hz is -1"));
  EXPECT_THAT(errors, HasSubstr("test.toml:3: sensors.dvl.beam_angle_deg is 90"));
  EXPECT_THAT(errors, HasSubstr("allowed is 1 to 80 deg"));
  EXPECT_THAT(errors, HasSubstr("sensors.dvl.noise"));
  EXPECT_THAT(errors, HasSubstr("sensors.sonar.rays is 600"));
  EXPECT_THAT(errors, HasSubstr("sensors.gps.dropout_probability is 1.5"));
  EXPECT_THAT(errors, HasSubstr("sensors.echo"));
  EXPECT_THAT(errors, HasSubstr("stuck-rudder, stuck-stern-planes, lost-propeller, leak, dead-sensor"));
  EXPECT_THAT(errors, HasSubstr("a time after at_s"));
  EXPECT_THAT(errors, HasSubstr("depth, altimeter, log, compass, gyro, dvl, gps, sonar, usbl"));
}

TEST(VehicleSimConfig, AFaultOfAnUnknownVehicleIsRefused) {
  const Read r = read("[[vehicle]]\nname = \"a\"\nid = 1\n[[fault]]\nvehicle = \"b\"\n");
  EXPECT_THROW(faults_of(members_of(r.scenario, r.config), r.config), InvalidArgument);
}

TEST(VehicleSimConfig, TheCurrentsOfAnOceanMoveNobodyWhereTheyAreNotToMoveVehicles) {
  const std::string ocean = "[ocean]\nfile = \"" HALOCLINE_SOURCE_DIR "/scenarios/front.nc\"\n";
  const std::string origin = "[scenario]\norigin_latitude_deg = 39.9\norigin_longitude_deg = -71.2\n";
  EXPECT_NE(moving_ocean(read(origin + ocean).scenario), nullptr);
  EXPECT_EQ(moving_ocean(read(origin + ocean + "moves_vehicles = false\n").scenario), nullptr);
}

TEST(VehicleSimConfig, TheEffectiveConfigurationReadsBackAsItself) {
  Read r = read(kWithSensors);
  const std::string text = bus::to_toml(
      [&](ConfigVisitor& v) {
        visit(v, r.scenario);
        visit(v, r.config);
      },
      true);
  const Read again = read(text);
  EXPECT_EQ(again.config.state_period, r.config.state_period);
  EXPECT_EQ(again.config.buoyancy_over_weight, 1.02);
  EXPECT_EQ(again.scenario.vehicles.size(), 2u);
  EXPECT_EQ(again.config.threads, 2);
  EXPECT_EQ(again.config.sensors, r.config.sensors);
  ASSERT_EQ(again.config.vehicles.size(), 2u);
  EXPECT_TRUE(again.config.vehicles[0].own);
  EXPECT_FALSE(again.config.vehicles[1].own);
  EXPECT_EQ(again.config.vehicles[0].sensors, r.config.vehicles[0].sensors);
  ASSERT_EQ(again.config.faults.size(), 2u);
  EXPECT_EQ(again.config.faults[0].fault.angle_rad, r.config.faults[0].fault.angle_rad);
  EXPECT_EQ(again.config.faults[0].until, SimTime::from_seconds(20));
}

}  // namespace
}  // namespace halocline::vehicle_sim
