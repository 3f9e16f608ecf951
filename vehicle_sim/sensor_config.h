// SPDX-License-Identifier: BSD-3-Clause
// Tables of a scenario: the sensors that vehicles carry, and faults.
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

// The keys of a [sensors].
void visit(bus::ConfigVisitor& v, SensorSettings& sensors);

// A fault of the scenario, its vehicle by name.
struct FaultEntry {
  std::string vehicle;
  Fault fault;
  SimTime until;  // mended from then on; not after fault.from: never
};

// The list [[fault]].
void visit_faults(bus::ConfigVisitor& v, std::vector<FaultEntry>& faults);

}  // namespace halocline::vehicle_sim
