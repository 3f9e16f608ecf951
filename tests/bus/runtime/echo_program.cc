// A node program for the tests of node_process.h: answers every CLOCK-shaped message on REQUEST with one on ANSWER.
#include <memory>

#include "bus/config/config.h"
#include "bus/runtime/node_process.h"
#include "tests/bus/runtime/test_nodes.h"

int main(int argc, char** argv) {
  double gain = 1;
  halocline::bus::NodeProgram program;
  program.program = "echo-program";
  program.purpose = "Answers.";
  program.node_name = "echo";
  program.interface = "receives:  REQUEST\npublishes: ANSWER, STATUS.<name>";
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) {
    v.section("echo", "The echo", [&](halocline::bus::ConfigVisitor& section) {
      section.number("gain", gain, {0, 10, "", "not used"});
    });
  };
  program.make_node = [](const halocline::bus::NodeProgram::Context& context) {
    return std::make_unique<halocline::bus::testing::EchoNode>(context.lcm, context.identity.name, "REQUEST",
                                                               "ANSWER", context.identity.session);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
