// SPDX-License-Identifier: BSD-3-Clause
// A scenario as one of several vehicle simulators has it, which share its vehicles in blocks.
#pragma once

#include <string>

#include "bus/runtime/scenario.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::vehicle_sim {

struct ScenarioPart {
  bus::Scenario scenario;
  VehicleSimConfig config;  // of one simulator that is alone
};

// The vehicles of config.block with their tethers and faults, and nothing of the others. Throws
// InvalidArgument where a tether or a fault of the scenario names no vehicle of ours, or a tether leads from
// block to block.
ScenarioPart part_of_block(const bus::Scenario& scenario, const VehicleSimConfig& config);

// "vehicle-sim", or of several "vehicle-sim-0", "vehicle-sim-1", ...
std::string node_name_of(const VehicleBlock& block);

}  // namespace halocline::vehicle_sim
