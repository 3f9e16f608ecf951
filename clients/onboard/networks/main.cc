// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "bus/runtime/node_process.h"
#include "clients/onboard/networks/network_config.h"
#include "clients/onboard/networks/network_node.h"

using halocline::bus::NodeProgram;

int main(int argc, char** argv) {
  halocline::networks::NetworkConfig config;
  NodeProgram program;
  program.program = "halocline-network";
  program.purpose = "Runs an example network protocol for the vehicles of a scenario.";
  program.node_name = "network";
  program.example_scenario = "scenarios/networks/one_hop.toml";
  program.stage = halocline::bus::Stage::kTraffic;
  program.interface =
      "receives:  CLOCK, RECEIPT.<vehicle>, RECEIVE.<vehicle>, MODEM_EVENT.<vehicle>,\n"
      "           GPS.<vehicle> (where it sets the vehicle's clock)\n"
      "publishes: SEND.<vehicle>, LISTEN.<vehicle>, NETWORK_EVENT.<vehicle>, STATUS.<name>";
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) { visit(v, config); };
  program.make_node = [&](const NodeProgram::Context& context) {
    return std::make_unique<halocline::networks::NetworkNode>(context.lcm, context.identity, config,
                                                              context.scenario.seed);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
