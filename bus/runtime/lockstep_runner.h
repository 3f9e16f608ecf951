// Runs many nodes in one process on one lcm::LCM (memq), all at one simulation time, as fast as they compute.
//
// The step order is that of lockstep_schedule.h. Nothing depends on a clock or a thread, so two runs publish the same
// messages in the same order.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/lockstep/lockstep_schedule.h"
#include "bus/runtime/node.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LockstepRunner {
 public:
  // The nodes step by stage, and within a stage by name, whatever their order here. `lcm` and the nodes must
  // outlive the runner.
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
  std::vector<ScheduleEntry> schedule_entries() const;
  void step_all_due();
  void drain();

  lcm::LCM& lcm_;
  std::vector<Node*> nodes_;
  std::function<bool(SimTime)> before_instant_;
  LockstepSchedule schedule_;
  SimTime now_;  // what is logged is stamped with it: the schedule's, or the end that was reached
};

}  // namespace halocline::bus
