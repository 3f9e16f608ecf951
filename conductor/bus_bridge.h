// SPDX-License-Identifier: BSD-3-Clause
// Bridge of a lockstep run to the ordinary bus: mirrors the messages of the run there, and receives those of
// other publishers, without its own echoes.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string_view>
#include <unordered_map>

#include "bus/bus.h"
#include "bus/messages/messages.h"

namespace halocline::conductor {

class BusBridge {
 public:
  // `on_message` gets the messages of other publishers; empty: no subscription.
  BusBridge(lcm::LCM& lcm, std::function<void(lockstep_message_t)> on_message);

  // Best effort: messages that LCM loses are not repaired.
  void mirror(const lockstep_message_t& message);

 private:
  void receive(std::string_view channel, const void* data, std::size_t size);

  bus::Bus bus_;
  std::function<void(lockstep_message_t)> on_message_;
  std::unordered_map<std::int64_t, int> echoes_;  // number of expected echoes by digest of the message
  std::deque<std::int64_t> in_order_;
};

}  // namespace halocline::conductor
