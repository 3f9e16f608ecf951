// SPDX-License-Identifier: BSD-3-Clause
// A node program for the tests of node_process.h: answers every CLOCK-shaped message on REQUEST with one on
// ANSWER.
#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "bus/config/config.h"
#include "bus/runtime/node_process.h"
#include "tests/bus/runtime/test_nodes.h"

namespace halocline::bus::testing {
namespace {

// Whose steps take a while once they have answered.
class SlowEchoNode : public EchoNode {
 public:
  SlowEchoNode(const NodeProgram::Context& context, double work_s)
      : EchoNode(context.lcm, context.identity.name, "REQUEST", "ANSWER", context.identity.session),
        work_s_(work_s) {}

 protected:
  void on_step(const Now& now) override {
    const int before = answers;
    EchoNode::on_step(now);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(work_s_);
    while (answers > before && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }

 private:
  double work_s_;
};

}  // namespace
}  // namespace halocline::bus::testing

int main(int argc, char** argv) {
  double gain = 1, work_s = 0;
  halocline::bus::NodeProgram program;
  program.program = "echo-program";
  program.purpose = "Answers.";
  program.node_name = "echo";
  program.interface = "receives:  REQUEST\npublishes: ANSWER, STATUS.<name>";
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) {
    v.section("echo", "The echo", [&](halocline::bus::ConfigVisitor& section) {
      section.number("gain", gain, {0, 10, "", "not used"});
      section.number("work_s", work_s, {0, 10'000, "s", "how long a step takes that answers"});
    });
  };
  program.make_node = [&](const halocline::bus::NodeProgram::Context& context) {
    return std::make_unique<halocline::bus::testing::SlowEchoNode>(context, work_s);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
