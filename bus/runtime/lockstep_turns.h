// SPDX-License-Identifier: BSD-3-Clause
// Executes the turns of a lockstep run for one node: delivers the turn's messages, steps the node if it is
// due, and returns the messages that it published and the time at which it is next due.
//
// Inputs are delivered as LCM would deliver them; outputs go only to the result. With lookahead (a turn whose
// lookahead lies beyond its instant) the node steps at its own instants until then, until it publishes a
// message that may advance the due time of a participant, or until it is due again at the instant of a step.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bus/messages/channel_pattern.h"
#include "bus/messages/messages.h"
#include "bus/runtime/node.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LockstepTurns {
 public:
  // The node must outlive this object, and must not be used by anybody else meanwhile.
  explicit LockstepTurns(Node& node);

  // Returns the node's LOCKSTEP_JOIN: its name, stage, subscriptions and first due instant.
  lockstep_join_t introduction() const;

  // Throws what the node throws, and when the node breaks its promise to store only (Wakeup::kStoreOnly).
  lockstep_result_t take(const lockstep_turn_t& turn);

 private:
  // Subscriptions of the node that match a channel.
  struct Interest {
    bool receives = false, may_wake = false;
  };
  Interest interest_in(const std::string& channel);
  void deliver(const std::vector<lockstep_message_t>& messages);
  bool must_pause(const lockstep_turn_t& turn, std::size_t published_before);
  const ChannelPattern& pattern_of(const std::string& expression);
  SimTime lookahead(const lockstep_turn_t& turn);

  Node& node_;
  std::map<std::string, Interest, std::less<>> interests_;
  std::map<std::string, ChannelPattern, std::less<>> stopping_;
  SimTime now_;
  std::vector<lockstep_message_t> published_;
  std::int64_t digest_ = 0;
};

}  // namespace halocline::bus
