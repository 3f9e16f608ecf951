// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/node_process.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/autopilot_node.h"

using halocline::clients::AutopilotConfig;
using halocline::clients::AutopilotNode;

int main(int argc, char** argv) {
  halocline::bus::NodeProgram program;
  program.program = "halocline-autopilot";
  program.purpose = "Steers the vehicles that have a [vehicle.mission] through their behaviours.";
  program.node_name = "autopilot";
  program.stage = halocline::bus::Stage::kPilots;
  program.keeps_state = true;
  program.interface =
      "receives:  CLOCK, STATE.<vehicle>, SENSORS.<vehicle>, DVL.<vehicle>, GPS.<vehicle>, USBL.<vehicle>,\n"
      "           ESTIMATE.<vehicle>,\n"
      "           RECEIPT.<vehicle>, RECEIVE.<vehicle>, BEST_PLACE_REPLY.<vehicle>\n"
      "publishes: COMMAND.<vehicle>, PLAN.<vehicle>, AUTOPILOT.<vehicle>, SEND.<vehicle>,\n"
      "           BEST_PLACE_QUERY, STATUS.<name>";
  return halocline::bus::run_node_program<AutopilotConfig, AutopilotNode>(argc, argv, program);
}
