// SPDX-License-Identifier: BSD-3-Clause
// Runs many nodes in one process, all at one simulation time, as fast as they compute.
//
// The order of steps is that of lockstep_schedule.h. Nodes of one stage that are due at the same instant may
// step on several threads: the messages of each are kept until all have stepped, then delivered in the order
// of the nodes' names. Messages are passed within the process, without LCM. Nothing depends on a clock or a
// thread, so two runs publish the same messages in the same order.
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
#include "bus/messages/message_batch.h"
#include "bus/runtime/node.h"
#include "core/for_each.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LockstepRunner {
 public:
  // Called with each message in order, once the nodes have received it. `at` is its time of publication.
  using Listener =
      std::function<void(SimTime at, std::string_view channel, std::span<const std::uint8_t> message)>;

  // The nodes step by stage, and within a stage by name, whatever their order in `nodes`. They must outlive
  // the runner, and must not be used by anybody else meanwhile. `for_each` distributes the nodes that step
  // together over threads.
  explicit LockstepRunner(std::vector<Node*> nodes, ForEach for_each = one_after_the_other);
  ~LockstepRunner();
  LockstepRunner(const LockstepRunner&) = delete;
  LockstepRunner& operator=(const LockstepRunner&) = delete;

  // Called with each instant before its nodes step, for pacing or progress. The run stops before that instant
  // if it returns false.
  void set_before_instant(std::function<bool(SimTime)> callback) { before_instant_ = std::move(callback); }
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  // Advances to `end`, including all instants at `end`. Throws what a node or a handler throws, and when
  // nodes wake each other at one instant without end.
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
  // Delivers the published messages to all nodes.
  void deliver();
  const std::vector<Node*>& receivers_of(std::string_view channel);

  std::vector<Node*> nodes_;
  std::vector<MessageBatch> published_;  // one batch for each node, not yet delivered
  MessageBatch delivered_;               // being delivered
  ForEach for_each_;
  std::function<bool(SimTime)> before_instant_;
  Listener listener_;
  std::unordered_map<std::string, std::vector<Node*>, ChannelHash, std::equal_to<>> receivers_;
  LockstepSchedule schedule_;
  SimTime now_;  // time stamp of messages: that of the schedule, or the end that was reached
};

}  // namespace halocline::bus
