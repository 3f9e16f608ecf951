// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "bus/runtime/node_process.h"
#include "conductor/conductor_node.h"
#include "conductor/lockstep_options.h"
#include "conductor/paced_time.h"

using halocline::bus::NodeProgram;

int main(int argc, char** argv) {
  halocline::conductor::LockstepOptions lockstep;
  NodeProgram program;
  program.program = "halocline-conductor";
  program.purpose =
      "Publishes simulation time, paced by the wall clock times the scenario's rate; or coordinates a "
      "lockstep run.";
  program.node_name = "conductor";
  program.interface =
      "receives:  STATE.*, STATUS.* (while starting: to take up a running system's time), CLOCK (of others)\n"
      "publishes: CLOCK, STATUS.<name>\n"
      "with --lockstep, on --sync-url: receives LOCKSTEP_JOIN, LOCKSTEP_ANSWER; publishes "
      "LOCKSTEP_GRANT[.<name>],\n"
      "           LOCKSTEP_NOTICE; and mirrors all messages of the run on the ordinary bus";
  program.options = lockstep.options();
  program.make_time_source = [](const NodeProgram::Context& context) {
    return std::make_unique<halocline::conductor::PacedTime>(context.lcm, context.scenario.rate);
  };
  program.make_node = [](const NodeProgram::Context& context) {
    return std::make_unique<halocline::conductor::ConductorNode>(
        context.lcm, context.identity, context.scenario.clock_period, context.scenario.rate);
  };
  program.run_otherwise = [&](const NodeProgram::Context& context) {
    return lockstep.run_if_requested(context);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
