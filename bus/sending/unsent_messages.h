// SPDX-License-Identifier: BSD-3-Clause
// What the network refused to take (no route, an interface that is down), in order, until it takes it.
//
// Bounded: after kKept, or beyond kMaxBytes, the oldest are forgotten; of flows they can still be repaired
// (flow_repair.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/sim_time.h"

namespace halocline::bus {

class UnsentMessages {
 public:
  static constexpr SimDuration kKept = SimDuration::from_milliseconds(10'000);
  static constexpr SimDuration kRetry = SimDuration::from_milliseconds(20);
  static constexpr std::size_t kMaxBytes = 4u << 20;  // and the last message whatever its size

  bool is_empty() const { return messages_.empty(); }
  void keep(SimTime steady, std::string_view channel, const void* data, std::size_t size);
  // Returns whether the network took it.
  using Send = std::function<bool(const std::string& channel, const void* data, std::size_t size)>;
  // Sends the oldest, and the next as long as the network takes them.
  void send(SimTime steady, const Send& send);
  // When send() is to be called again; never() while there is none.
  SimTime next_due() const { return messages_.empty() ? SimTime::never() : next_due_; }

 private:
  struct Message {
    SimTime since;
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  void forget_first();

  std::deque<Message> messages_;
  std::size_t bytes_ = 0;
  SimTime next_due_;
};

}  // namespace halocline::bus
