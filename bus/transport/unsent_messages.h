// SPDX-License-Identifier: BSD-3-Clause
// Queue of messages that the network refused (no route, an interface that is down), in order, until it
// accepts them.
//
// The queue is bounded: messages older than kKept are dropped, and the oldest ones beyond kMaxBytes. Messages
// of flows can still be repaired (flow_repair.h).
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
  static constexpr std::size_t kMaxBytes = 4u << 20;  // the last message is kept whatever its size

  bool is_empty() const { return messages_.empty(); }
  void keep(SimTime steady, std::string_view channel, const void* data, std::size_t size);
  // Returns true if the network accepted the message.
  using Send = std::function<bool(const std::string& channel, const void* data, std::size_t size)>;
  // Sends the oldest message, and the following ones as long as the network accepts them.
  void send(SimTime steady, const Send& send);
  // Time at which to call send() again; never() if the queue is empty.
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
