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
#include "bus/config/scenario.h"
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

// Tether in a scenario, with its ends by name.
struct TetherEntry {
  std::string vehicle;                   // must be one that the simulator moves
  Vec3 attached_at_m = Vec3::Zero();     // from the hull's middle: forward, starboard, down
  std::string to_vehicle;                // another vehicle, which may be fixed; empty: a fixed point
  Vec3 to_attached_at_m = Vec3::Zero();  // from the other hull's middle; a fixed point in the world frame
  double length_m = 10;
};

struct VehicleSensors {
  std::string vehicle;
  bool own = false;  // true with a [vehicle.sensors], or a model whose file has [sensors]
  SensorSettings sensors;
};

// Vehicles that one of several simulators moves. The vehicles that are not "external" are divided into
// `count` blocks in the order of the scenario, equal in size to within one vehicle. Each vehicle moves and
// measures as in one simulator of all vehicles, to the last bit, except that hulls of different blocks pass
// through each other. A tether must connect vehicles of one block.
struct VehicleBlock {
  int index = 0;  // 0 to count - 1
  int count = 1;  // 1 to kMaxBlocks

  bool is_alone() const { return count == 1; }
  // Returns the block of the vehicle with index `member` among `members`.
  std::size_t of(std::size_t member, std::size_t members) const {
    return member * static_cast<std::size_t>(count) / members;
  }
};
inline constexpr int kMaxBlocks = 64;

struct VehicleSimConfig {
  SimDuration step = SimDuration::from_milliseconds(10);               // physics step
  SimDuration state_period = SimDuration::from_milliseconds(100);      // interval of STATE, or of its ticks
  StateRule states;                                                    // selection of the ticks with a STATE
  SimDuration sensor_period = SimDuration::from_milliseconds(200);     // interval of SENSORS messages
  SimDuration command_timeout = SimDuration::from_milliseconds(2000);  // age at which a command ends
  double altimeter_range_m = 100;
  CurrentSettings current;
  WaveSettings waves;
  double buoyancy_over_weight = 1;
  int threads = 1;  // number of threads; the motion does not depend on it
  VehicleBlock block;
  std::vector<TetherEntry> tethers;
  SensorSettings sensors;                // sensors of vehicles without their own
  std::vector<VehicleSensors> vehicles;  // one entry for each vehicle of the scenario
  std::vector<FaultEntry> faults;
};

// Visits the sections [vehicle_sim], [vehicle_sim.current], [vehicle_sim.waves], [sensors],
// [vehicle.sensors], [[tether]] and [[fault]], and reports each [[vehicle]] whose model is unknown.
void visit(bus::ConfigVisitor& v, VehicleSimConfig& config);

inline std::optional<BatterySettings> to_settings(const std::optional<bus::VehicleBattery>& b) {
  if (!b) return std::nullopt;
  return BatterySettings{b->capacity_j, b->hotel_w + b->listening_w, b->shaft_efficiency};
}

// Returns the vehicles of the scenario that the simulator moves or holds, which excludes "external" ones. A
// vehicle starts level, at its set speed through the water (without the motion of waves). Throws
// InvalidArgument when a model is unknown, and bus::ConfigErrors when a model file has errors.
std::vector<FleetMember> members_of(const bus::Scenario& scenario, const VehicleSimConfig& config);

// Throws InvalidArgument when a tether names a vehicle that the simulator does not have, or connects two
// blocks.
FleetSettings settings_of(const bus::Scenario& scenario, const VehicleSimConfig& config);

// Returns the sensors of `members`, in their order.
std::vector<SensorStation::Vehicle> stations_of(const bus::Scenario& scenario,
                                                const std::vector<FleetMember>& members,
                                                const VehicleSimConfig& config);

// Returns the faults of the scenario and their ends, each with the index of its member. Throws
// InvalidArgument when a fault names a vehicle that the simulator does not have.
std::vector<std::pair<std::size_t, Fault>> faults_of(const std::vector<FleetMember>& members,
                                                     const VehicleSimConfig& config);

}  // namespace halocline::vehicle_sim
