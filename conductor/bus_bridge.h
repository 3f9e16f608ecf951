// SPDX-License-Identifier: BSD-3-Clause
// Mirrors the messages of a lockstep run on the ordinary bus, and receives those of other publishers there:
// all but its own echoes.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string_view>
#include <unordered_map>

#include "bus/bus.h"
#include "bus/messages.h"

namespace halocline::conductor {

class BusBridge {
 public:
  // `on_message` gets those of other publishers; empty: nothing is subscribed to.
  BusBridge(lcm::LCM& lcm, std::function<void(lockstep_message_t)> on_message);

  // Best effort: what LCM loses is lost.
  void mirror(const lockstep_message_t& message);

 private:
  void receive(std::string_view channel, const void* data, std::size_t size);

  bus::Bus bus_;
  std::function<void(lockstep_message_t)> on_message_;
  std::unordered_map<std::int64_t, int> echoes_;  // how many are expected back, by the digest of the message
  std::deque<std::int64_t> in_order_;
};

}  // namespace halocline::conductor
