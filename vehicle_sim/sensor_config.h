// SPDX-License-Identifier: BSD-3-Clause
// Sensors and faults in a scenario file.
//
//   [sensors.dvl]                # of every vehicle
//   rate_hz = 5
//   noise_mps = 0.004
//
//   [vehicle.sensors.compass]    # of the [[vehicle]] above it, where it differs
//   noise_deg = 0.5
//
//   [[fault]]
//   vehicle = "auv-1"
//   kind = "leak"
//   at_s = 300
//   leak_kg_per_s = 0.01
//   leak_volume_m3 = 0.002
#pragma once

#include <string>
#include <vector>

#include "bus/config/config.h"
#include "core/sim_time.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/sensors/sensor_settings.h"

namespace halocline::vehicle_sim {

// Visits the keys of a table [sensors].
void visit(bus::ConfigVisitor& v, SensorSettings& sensors);

// Fault in a scenario, with its vehicle by name.
struct FaultEntry {
  std::string vehicle;
  Fault fault;
  SimTime until;  // time of the repair; not after fault.from: never repaired
};

void visit_faults(bus::ConfigVisitor& v, std::vector<FaultEntry>& faults);

}  // namespace halocline::vehicle_sim
