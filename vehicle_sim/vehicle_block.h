// SPDX-License-Identifier: BSD-3-Clause
// Part of a scenario for one of several vehicle simulators, which divide its vehicles into blocks.
#pragma once

#include <string>

#include "bus/config/scenario.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::vehicle_sim {

struct ScenarioPart {
  bus::Scenario scenario;
  VehicleSimConfig config;  // settings of a simulator that runs alone
};

// Returns the vehicles of config.block with their tethers and faults. Throws InvalidArgument when a tether or
// a fault names a vehicle that no simulator moves or holds, or when a tether connects two blocks.
ScenarioPart part_of_block(const bus::Scenario& scenario, const VehicleSimConfig& config);

// Returns the node's name: "vehicle-sim", or "vehicle-sim-0", "vehicle-sim-1", ... when there are several.
std::string node_name_of(const VehicleBlock& block);

}  // namespace halocline::vehicle_sim
