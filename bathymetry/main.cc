// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <utility>

#include "bathymetry/bathymetry_config.h"
#include "bathymetry/bathymetry_node.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/config/config.h"
#include "bus/runtime/node_process.h"

using halocline::bathymetry::BathymetryNode;
using halocline::bathymetry::PreparedTerrain;
using halocline::bathymetry::TerrainRecipe;
using halocline::bus::NodeProgram;

int main(int argc, char** argv) {
  TerrainRecipe recipe;
  NodeProgram program;
  program.program = "halocline-bathymetry";
  program.purpose = "Answers batches of ray and depth queries, and tiles, over the scenario's seabed.";
  program.node_name = "bathymetry";
  program.stage = halocline::bus::Stage::kTerrain;
  program.interface =
      "receives:  RAY_QUERY, TERRAIN_QUERY, CLOCK\n"
      "publishes: TERRAIN, RAY_REPLY.<client>, TERRAIN_REPLY.<client>, STATUS.<name>";
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) { visit(v, recipe); };
  program.make_node = [&](const NodeProgram::Context& context) {
    PreparedTerrain prepared = prepare_terrain(
        recipe, {context.scenario.origin_latitude_deg, context.scenario.origin_longitude_deg});
    return std::make_unique<BathymetryNode>(context.lcm, context.identity, std::move(prepared.terrain),
                                            std::move(prepared.summary));
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
