// SPDX-License-Identifier: BSD-3-Clause
// Runs many nodes in one process, all at one simulation time, as fast as they compute.
//
// The step order is that of lockstep_schedule.h. Nodes that step together, those of one stage that are due at
// one instant, may do so on several threads: what each publishes is kept until all have stepped, then
// delivered in the order of their names. Messages go from node to node within the process, through no LCM.
// Nothing depends on a clock or a thread, so two runs publish the same messages in the same order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bus/lockstep/lockstep_schedule.h"
#include "bus/message_batch.h"
#include "bus/runtime/node.h"
#include "core/for_each.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LockstepRunner {
 public:
  // Of each message in its order, once the nodes have received it. `at`: when it was published.
  using Listener =
      std::function<void(SimTime at, std::string_view channel, std::span<const std::uint8_t> message)>;

  // The nodes step by stage, and within a stage by name, whatever their order here. They must outlive the
  // runner, and are nobody else's meanwhile. `for_each` shares those that step together among threads.
  explicit LockstepRunner(std::vector<Node*> nodes, ForEach for_each = one_after_the_other);
  ~LockstepRunner();
  LockstepRunner(const LockstepRunner&) = delete;
  LockstepRunner& operator=(const LockstepRunner&) = delete;

  // Called with each instant before its nodes step: pacing, progress. It may return false to stop the run
  // before that instant.
  void set_before_instant(std::function<bool(SimTime)> callback) { before_instant_ = std::move(callback); }
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  // Advances to `end`, all instants at `end` included. Throws what a node or a handler throws, and when
  // nodes keep each other busy at one instant without end.
  void run_until(SimTime end);
  // Stops each node, in order, at the time reached.
  void stop();

  SimTime now() const { return now_; }

 private:
  struct ChannelHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view channel) const { return std::hash<std::string_view>()(channel); }
  };

  std::vector<ScheduleEntry> schedule_entries() const;
  void step_all_due();
  // What the nodes published, to all.
  void deliver();
  const std::vector<Node*>& receivers_of(std::string_view channel);

  std::vector<Node*> nodes_;
  std::vector<MessageBatch> published_;  // by each node, not yet delivered
  MessageBatch delivered_;               // now
  ForEach for_each_;
  std::function<bool(SimTime)> before_instant_;
  Listener listener_;
  std::unordered_map<std::string, std::vector<Node*>, ChannelHash, std::equal_to<>> receivers_;  // by channel
  LockstepSchedule schedule_;
  SimTime now_;  // messages are stamped with it: the schedule's, or the end that was reached
};

}  // namespace halocline::bus
