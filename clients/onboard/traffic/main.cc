// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "bus/config/config.h"
#include "bus/runtime/node_process.h"
#include "clients/onboard/traffic/traffic_config.h"
#include "clients/onboard/traffic/traffic_node.h"

using halocline::bus::NodeProgram;

int main(int argc, char** argv) {
  halocline::clients::TrafficConfig config;
  NodeProgram program;
  program.program = "halocline-traffic";
  program.purpose = "Sends packets for the vehicles that have a [vehicle.traffic], and counts what arrives.";
  program.node_name = "traffic";
  program.stage = halocline::bus::Stage::kTraffic;
  program.keeps_state = true;
  program.interface =
      "receives:  CLOCK, RECEIPT.<vehicle>, RECEIVE.<vehicle>, GPS.<vehicle> (where it sets the vehicle's "
      "clock)\n"
      "publishes: SEND.<vehicle>, STATUS.<name>";
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) { visit(v, config); };
  program.make_node = [&](const NodeProgram::Context& context) {
    return std::make_unique<halocline::clients::TrafficNode>(context.lcm, context.identity, config);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
