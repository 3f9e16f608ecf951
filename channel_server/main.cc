// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "bathymetry/bathymetry_config.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "bus/runtime/node_command_line.h"
#include "bus/runtime/node_process.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/channel_server_node.h"
#include "core/check.h"

using halocline::require;
using halocline::bus::NodeProgram;
using halocline::bus::part_settings;
using halocline::channel_server::ChannelServerConfig;
using halocline::channel_server::make_channel_server;

int main(int argc, char** argv) {
  ChannelServerConfig config;
  NodeProgram program;
  program.program = "halocline-channel-server";
  program.purpose = "Simulates the acoustic channel: link qualities, transmissions and their outcomes.";
  program.node_name = "channel-server";
  program.stage = halocline::bus::Stage::kChannel;
  program.interface =
      "subscribes: STATE.<vehicle>, MODEM.<vehicle>, LISTEN.<vehicle>, SEND.<vehicle>, LINK_QUERY, "
      "BEST_PLACE_QUERY,\n            SET_ENVIRONMENT,\n"
      "            GPS.<vehicle> (of vehicles with a clock), BATTERY.<vehicle> (with a battery),\n"
      "            SENSORS.<vehicle> (whose propeller makes noise),\n"
      "            MODEM_REPLY, FOUND_PATHS.<itself> (of other shards),\n"
      "            RAY_REPLY.<itself>, CLOCK (with --time-source conductor)\n"
      "publishes:  LINKS.<vehicle>, RECEIPT.<vehicle>, RECEIVE.<vehicle>, MODEM_EVENT.<vehicle>, OUTCOME,\n"
      "            ENVIRONMENT, SCENARIO,\n"
      "            LINK_REPLY.<client>, BEST_PLACE_REPLY.<client>, RAY_QUERY, MODEM_REPLY and "
      "FOUND_PATHS.<shard> (as a shard),\n"
      "            MODEM_ENERGY.<vehicle> (of vehicles with a battery), STATUS.<name>";
  // The terrain tells the noise of the place where the scenario leaves it to the depth.
  halocline::bathymetry::TerrainRecipe recipe;
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) {
    visit(v, config);
    if (needs_depth(config.environment)) visit(v, recipe);
  };
  std::string share, journal;
  program.options = {
      {"--shard", "I/N: serve the I-th share of the vehicles, beside N - 1 other servers", &share, nullptr,
       [](const std::string& value) {
         return part_settings("--shard", value, "channel_server.shard", "channel_server.shards");
       }},
      {"--journal", "file from which a server that was killed goes on where it was (not in lockstep)",
       &journal}};
  program.default_name = [&] {
    const auto& shard = config.rules.medium.shard;
    return "channel-server" + (shard.is_alone() ? "" : "-" + std::to_string(shard.index));
  };
  program.make_node = [&](const NodeProgram::Context& context) {
    halocline::bus::Scenario scenario = context.scenario;
    scenario.configuration = configuration_of(*context.file);
    if (needs_depth(config.environment)) {
      const halocline::bathymetry::Site site{scenario.origin_latitude_deg, scenario.origin_longitude_deg};
      use_depth(mean_water_depth_m(recipe, site, scenario.sea_surface_z_m), config.environment);
    }
    auto node = make_channel_server(context.lcm, context.identity, config, scenario);
    require(journal.empty() || !context.in_lockstep,
            "--journal is " + journal + "; in lockstep the conductor has the journal of all");
    if (!journal.empty()) node->open_journal(journal, context.config_digest);
    return node;
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
