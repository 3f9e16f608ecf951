// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>

#include "bathymetry/bathymetry_config.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/config/config.h"
#include "bus/runtime/node_command_line.h"
#include "bus/runtime/node_process.h"
#include "vehicle_sim/start_checks.h"
#include "vehicle_sim/vehicle_block.h"
#include "vehicle_sim/vehicle_sim_config.h"
#include "vehicle_sim/vehicle_sim_node.h"
#include "vehicle_sim/world/terrain_seabed.h"

using halocline::bus::NodeProgram;
using halocline::bus::part_settings;
using halocline::vehicle_sim::node_name_of;
using halocline::vehicle_sim::part_of_block;
using halocline::vehicle_sim::TerrainSeabed;
using halocline::vehicle_sim::VehicleSimConfig;
using halocline::vehicle_sim::VehicleSimNode;

int main(int argc, char** argv) {
  halocline::bathymetry::TerrainRecipe recipe;
  VehicleSimConfig config;
  NodeProgram program;
  program.program = "halocline-vehicle-sim";
  program.purpose = "Moves the scenario's vehicles and publishes their states and sensors.";
  program.node_name = "vehicle-sim";
  program.stage = halocline::bus::Stage::kVehicles;
  program.keeps_state = true;
  program.interface =
      "receives:  COMMAND.<vehicle>, FAULT.<vehicle>, SET_CURRENT, RAY_REPLY.<client>, CLOCK; with a USBL "
      "array OUTCOME,\n"
      "           RECEIVE.<vehicle>\n"
      "publishes: STATE.<vehicle>, SENSORS.<vehicle>, DVL.<vehicle>, GPS.<vehicle>, SONAR.<vehicle>, "
      "USBL.<vehicle>,\n"
      "           FAULT.<vehicle> (of the scenario), RAY_QUERY, STATUS.<name>";
  std::string block;
  program.options = {{"--block", "I/N: the I-th of N blocks of the vehicles, beside N - 1 other simulators",
                      &block, nullptr, [](const std::string& value) {
                        return part_settings("--block", value, "vehicle_sim.block", "vehicle_sim.blocks");
                      }}};
  program.default_name = [&] { return node_name_of(config.block); };
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) {
    visit(v, recipe);
    visit(v, config);
  };
  // The seabed that hulls touch is the terrain of the bathymetry service, built in this process from the same
  // recipe.
  program.make_node = [&](const NodeProgram::Context& context) {
    const auto prepared = prepare_terrain(
        recipe, {context.scenario.origin_latitude_deg, context.scenario.origin_longitude_deg});
    const auto seabed = std::make_shared<TerrainSeabed>(prepared.terrain);
    if (context.file != nullptr) {
      check_starts(context.scenario, *seabed, extent_text(*prepared.terrain), *context.file);
      context.file->check_findings();
    }
    const auto [scenario, own] = part_of_block(context.scenario, config);
    return std::make_unique<VehicleSimNode>(context.lcm, context.identity, scenario, own, seabed);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
