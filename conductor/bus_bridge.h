// Shows a lockstep run on the ordinary bus, and hears what others say there: all but what the run itself shows.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <unordered_map>

#include "bus/bus.h"
#include "bus/messages.h"

namespace halocline::conductor {

class BusBridge {
 public:
  // `heard`: what others say; empty when nobody wants to know (then nothing is subscribed to).
  BusBridge(lcm::LCM& lcm, std::function<void(lockstep_message_t)> heard);

  // Best effort: what LCM loses is lost.
  void show(const lockstep_message_t& message);

 private:
  void on_message(std::string_view channel, const void* data, std::size_t size);

  bus::Bus bus_;
  std::function<void(lockstep_message_t)> heard_;
  std::unordered_map<std::int64_t, int> echoes_;  // how many are expected back, by the digest of the message
  std::deque<std::int64_t> in_order_;
};

}  // namespace halocline::conductor
