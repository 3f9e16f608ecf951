// Runs many nodes in one process on one lcm::LCM (memq), all at one simulation time, as fast as they compute.
//
// Discrete events: time goes to the earliest instant any node is due; there every node that is due steps, in
// the order given, and the bus is drained after each, until none is due any more; then time goes on. Nothing
// depends on a clock or a thread, so two runs publish the same messages in the same order.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/node.h"

namespace halocline::bus {

class LockstepRunner {
 public:
  // `nodes` step in this order: who moves vehicles first, then who pilots them, the channel server last.
  // `lcm` and the nodes must outlive the runner.
  LockstepRunner(lcm::LCM& lcm, std::vector<Node*> nodes);

  // Called with each instant before its nodes step: pacing, progress, the stamp of a log. It may return false
  // to stop the run before that instant.
  void set_before_instant(std::function<bool(SimTime)> callback) { before_instant_ = std::move(callback); }

  // Advances to `end`, all instants at `end` included. Throws what a node or a handler throws, and when
  // nodes keep each other busy at one instant without end.
  void run_until(SimTime end);
  // Stops each node, in order, at the time reached.
  void stop();

  SimTime now() const { return now_; }

 private:
  SimTime next_instant() const;
  void step_all_due();
  void drain();

  lcm::LCM& lcm_;
  std::vector<Node*> nodes_;
  std::function<bool(SimTime)> before_instant_;
  SimTime now_;
};

}  // namespace halocline::bus
