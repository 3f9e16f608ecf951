// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the vehicle simulator: section [vehicle_sim] of a scenario, and the vehicles that it
// moves.
//
//   [vehicle_sim]
//   state_rate_hz = 10
//   current_ned_mps = [0.1, 0.0, 0.0]
//
//   [[tether]]
//   vehicle = "tug"
//   to_vehicle = "float"
//   length_m = 20
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/config/config.h"
#include "bus/runtime/scenario.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/dynamics/waves.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/power/battery.h"
#include "vehicle_sim/sensor_config.h"
#include "vehicle_sim/sensor_station.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/state_selection.h"

namespace halocline::vehicle_sim {

// The model's own treatment of the current, or one for all.
enum class TreatmentChoice { kModel, kUpstream, kGalilean };

// A rope of the scenario, its ends by name.
struct TetherEntry {
  std::string vehicle;                   // one that we move
  Vec3 attached_at_m = Vec3::Zero();     // from the hull's middle: forward, starboard, down
  std::string to_vehicle;                // another, also a fixed one; empty: a fixed point
  Vec3 to_attached_at_m = Vec3::Zero();  // of the other hull; of a fixed point, in the world frame
  double length_m = 10;
};

// The sensors of one vehicle of the scenario.
struct VehicleSensors {
  std::string vehicle;
  bool own = false;  // has a [vehicle.sensors], or a model whose file has [sensors]
  SensorSettings sensors;
};

// Which vehicles one of several simulators moves. Those that are not "external" are cut into `count` blocks
// in the order of the scenario, of equal size but for one vehicle. Each moves and measures as beside all
// others, to the last bit, except that hulls of different blocks pass through each other. A tether joins
// vehicles of one block.
struct VehicleBlock {
  int index = 0;  // 0 to count - 1
  int count = 1;  // 1 to kMaxBlocks

  bool is_alone() const { return count == 1; }
  // The block of the `member`-th of so many vehicles, from 0.
  std::size_t of(std::size_t member, std::size_t members) const {
    return member * static_cast<std::size_t>(count) / members;
  }
};
inline constexpr int kMaxBlocks = 64;

struct VehicleSimConfig {
  SimDuration step = SimDuration::from_milliseconds(10);               // of the physics
  SimDuration state_period = SimDuration::from_milliseconds(100);      // between STATEs, or their ticks
  StateRule states;                                                    // which ticks have one
  SimDuration sensor_period = SimDuration::from_milliseconds(200);     // between SENSORS
  SimDuration command_timeout = SimDuration::from_milliseconds(2000);  // age at which a command is void
  double altimeter_range_m = 100;
  SimDuration echo_timeout = SimDuration::from_milliseconds(250);  // wait for the bathymetry service
  CurrentSettings current;
  WaveSettings waves;
  TreatmentChoice current_treatment = TreatmentChoice::kModel;
  double buoyancy_over_weight = 1;
  double seabed_friction = VehicleWorld::kDefaultFriction;
  int threads = 1;  // that move vehicles; the motion is the same for any number
  VehicleBlock block;
  std::vector<TetherEntry> tethers;
  SensorSettings sensors;                // of every vehicle without its own
  std::vector<VehicleSensors> vehicles;  // of the scenario
  std::vector<FaultEntry> faults;
};

// Sections [vehicle_sim], [vehicle_sim.current], [vehicle_sim.waves], [sensors], [vehicle.sensors],
// [[tether]] and [[fault]]; also reports each [[vehicle]] whose model is none.
void visit(bus::ConfigVisitor& v, VehicleSimConfig& config);

inline std::optional<BatterySettings> to_settings(const std::optional<bus::VehicleBattery>& b) {
  if (!b) return std::nullopt;
  return BatterySettings{b->capacity_j, b->hotel_w + b->listening_w, b->shaft_efficiency};
}

// The vehicles of the scenario that the simulator moves or holds ("external" ones are not its own). A vehicle
// starts level, with its speed through the water (waves left aside). Throws InvalidArgument where the model
// is unknown, bus::ConfigErrors where its file is wrong.
std::vector<FleetMember> members_of(const bus::Scenario& scenario, const VehicleSimConfig& config);

// Throws InvalidArgument where a tether names no vehicle of ours, or leads from block to block.
FleetSettings settings_of(const bus::Scenario& scenario, const VehicleSimConfig& config);

// Their sensors, in the order of `members`.
std::vector<SensorStation::Vehicle> stations_of(const bus::Scenario& scenario,
                                                const std::vector<FleetMember>& members,
                                                const VehicleSimConfig& config);

// Faults of the scenario, each by the index of its member, and their ends. Throws InvalidArgument where one
// names no vehicle of ours.
std::vector<std::pair<std::size_t, Fault>> faults_of(const std::vector<FleetMember>& members,
                                                     const VehicleSimConfig& config);

}  // namespace halocline::vehicle_sim
