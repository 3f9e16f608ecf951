// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/node_process.h"
#include "clients/onboard/traffic/traffic_config.h"
#include "clients/onboard/traffic/traffic_node.h"

using halocline::clients::TrafficConfig;
using halocline::clients::TrafficNode;

int main(int argc, char** argv) {
  halocline::bus::NodeProgram program;
  program.program = "halocline-traffic";
  program.purpose = "Sends packets for the vehicles that have a [vehicle.traffic], and counts what arrives.";
  program.node_name = "traffic";
  program.stage = halocline::bus::Stage::kTraffic;
  program.keeps_state = true;
  program.interface =
      "receives:  CLOCK, RECEIPT.<vehicle>, RECEIVE.<vehicle>, GPS.<vehicle> (where it sets the vehicle's "
      "clock)\n"
      "publishes: SEND.<vehicle>, STATUS.<name>";
  return halocline::bus::run_node_program<TrafficConfig, TrafficNode>(argc, argv, program);
}
