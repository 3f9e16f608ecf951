// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/node_process.h"
#include "clients/onboard/localiser/localiser_config.h"
#include "clients/onboard/localiser/localiser_node.h"

using halocline::clients::LocaliserConfig;
using halocline::clients::LocaliserNode;

int main(int argc, char** argv) {
  halocline::bus::NodeProgram program;
  program.program = "halocline-localiser";
  program.purpose = "Finds the places of the vehicles that have a [vehicle.localiser], by ranges to beacons.";
  program.node_name = "localiser";
  program.stage = halocline::bus::Stage::kClients;
  program.keeps_state = true;
  program.interface =
      "receives:  CLOCK, ENVIRONMENT, SENSORS.<vehicle>, RECEIPT.<vehicle>, RECEIVE.<vehicle>,\n"
      "           GPS.<vehicle> (where it sets its clock, or that is estimated);\n"
      "           STATE.<vehicle>, to compute the error\n"
      "publishes: SEND.<vehicle>, ESTIMATE.<vehicle>, STATUS.<name>";
  return halocline::bus::run_node_program<LocaliserConfig, LocaliserNode>(argc, argv, program);
}
