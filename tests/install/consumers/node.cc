// SPDX-License-Identifier: BSD-3-Clause
// A node: steps once a second of simulation time, and says so. node [SCENARIO] [OPTION...]
#include "bus/runtime/node.h"

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "bus/runtime/node_process.h"
#include "core/sim_time.h"

namespace hb = halocline::bus;

class Ticker : public hb::Node {
 public:
  using hb::Node::Node;

 protected:
  hb::Due on_due() const override { return {.sim = next_}; }
  void on_step(const hb::Now& now) override {
    std::printf("step at %.0f s\n", now.sim.seconds());
    std::fflush(stdout);
    next_ = halocline::next_on_grid(now.sim, halocline::SimDuration::from_seconds(1));
  }
  std::string status_text() const override { return "ticking"; }

 private:
  halocline::SimTime next_;
};

int main(int argc, char** argv) {
  hb::NodeProgram program;
  program.program = "node";
  program.purpose = "Steps once a second.";
  program.node_name = "ticker";
  program.interface = "receives:  CLOCK\npublishes: STATUS.<name>";
  program.make_node = [](const hb::NodeProgram::Context& context) {
    return std::make_unique<Ticker>(context.lcm, context.identity);
  };
  return hb::run_node_program(argc, argv, program);
}
