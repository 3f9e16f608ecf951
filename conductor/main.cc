#include "bus/node_process.h"
#include "conductor/conductor_node.h"
#include "conductor/paced_time.h"

using halocline::bus::NodeProgram;

int main(int argc, char** argv) {
  NodeProgram program;
  program.program = "halocline-conductor";
  program.purpose = "Publishes simulation time, paced by the wall clock times the scenario's rate.";
  program.node_name = "conductor";
  program.interface =
      "hears:     STATE.*, STATUS.* (while starting: to take up a running system's time)\n"
      "publishes: CLOCK, STATUS.<name>";
  program.make_time_source = [](const NodeProgram::Context& context) {
    return std::make_unique<halocline::conductor::PacedTime>(context.lcm, context.scenario.rate);
  };
  program.make_node = [](const NodeProgram::Context& context) {
    return std::make_unique<halocline::conductor::ConductorNode>(
        context.lcm, context.identity, context.scenario.clock_period, context.scenario.rate);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
