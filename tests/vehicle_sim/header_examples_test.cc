// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of vehicle_sim/, compiled and run (tests/docs/check_examples).
#include <string>

#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::vehicle_sim {
namespace {

TEST(HeaderExamples, EquationsOfMotion) {
  const Model model(remus100_pvs_parameters(CurrentTreatment::kUpstream));
  VehicleState state;
  for (int i = 0; i < 1000; ++i) state = rk4_step(model, state, {.propeller_hz = 20}, Water{}, 0.01);
  EXPECT_GT(state.position_ned_m.x(), 5);
  EXPECT_LT(state.position_ned_m.x(), 30);
}

VehicleSimConfig read(const std::string& toml) {
  bus::Scenario scenario;
  VehicleSimConfig config;
  bus::ConfigFile file = bus::ConfigFile::parse(toml, "test.toml");
  file.read([&](bus::ConfigVisitor& v) { visit(v, scenario); });
  file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/true);
  return config;
}

TEST(HeaderExamples, SensorConfig) {
  const VehicleSimConfig config = read(R"(
[[vehicle]]
name = "auv-1"
id = 1

[sensors.dvl]                # of every vehicle
rate_hz = 5
noise_mps = 0.004

[vehicle.sensors.compass]    # of the [[vehicle]] above it, where it differs
noise_deg = 0.5

[[fault]]
vehicle = "auv-1"
kind = "leak"
at_s = 300
leak_kg_per_s = 0.01
leak_volume_m3 = 0.002
)");
  EXPECT_EQ(config.sensors.dvl.errors.noise, 0.004);
  EXPECT_EQ(config.vehicles.at(0).sensors.compass.errors.noise, to_radians(0.5));
  EXPECT_EQ(config.vehicles.at(0).sensors.dvl, config.sensors.dvl);
  EXPECT_EQ(config.faults.at(0).fault.leak_volume_m3, 0.002);
}

TEST(HeaderExamples, VehicleSimConfig) {
  const VehicleSimConfig config = read(R"(
[[vehicle]]
name = "tug"
id = 1

[[vehicle]]
name = "float"
id = 2

[vehicle_sim]
state_rate_hz = 10
current_ned_mps = [0.1, 0.0, 0.0]

[[tether]]
vehicle = "tug"
to_vehicle = "float"
length_m = 20
)");
  EXPECT_EQ(config.state_period, SimDuration::from_milliseconds(100));
  EXPECT_EQ(config.tethers.at(0).length_m, 20);
}

}  // namespace
}  // namespace halocline::vehicle_sim
