// A node's side of lockstep: takes turns. Hears what it is told to hear, steps if it is due, and gives back all it
// said and when it is next due.
//
// The node is on a memq LCM of its own, so it runs unchanged: what is heard is published there for it, and
// what it says goes to nobody but the result. In a window (a turn whose horizon lies beyond its instant) it
// goes on through its own instants until the horizon, or until it says something that somebody must hear at
// once.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/channel_pattern.h"
#include "bus/messages.h"
#include "bus/runtime/node.h"

namespace halocline::bus {

class LockstepTurns {
 public:
  // `memq` carries this node alone; both must outlive this.
  LockstepTurns(lcm::LCM& memq, Node& node);

  // The node as a participant, for LOCKSTEP_JOIN: its name, stage, subscriptions and first due instant.
  lockstep_join_t introduction() const;

  // Throws what the node throws, and when the node broke its promise only to store (Wakeup::kStoreOnly).
  lockstep_result_t take(const lockstep_turn_t& turn);

 private:
  // What this node does with a channel.
  struct Interest {
    bool hears = false, may_wake = false;
  };
  Interest interest_in(const std::string& channel);
  void hear(const std::vector<lockstep_message_t>& heard);
  bool must_pause(const lockstep_turn_t& turn, std::size_t said_before);

  lcm::LCM& memq_;
  Node& node_;
  std::map<std::string, Interest, std::less<>> interests_;
  std::map<std::string, ChannelPattern, std::less<>> stopping_;
  SimTime now_;
  std::vector<lockstep_message_t> said_;
  std::int64_t digest_ = 0;
};

}  // namespace halocline::bus
