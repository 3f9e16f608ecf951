// SPDX-License-Identifier: BSD-3-Clause
// Batch of messages in one buffer, in the order in which they were added.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/sim_time.h"

namespace halocline::bus {

class MessageBatch {
 public:
  void add(SimTime at, std::string_view channel, std::span<const std::uint8_t> message) {
    bytes_.insert(bytes_.end(), message.begin(), message.end());
    messages_.push_back({at, std::string(channel), bytes_.size()});
  }

  bool empty() const { return messages_.empty(); }
  std::size_t size_bytes() const { return bytes_.size(); }  // sum over all messages, without their channels
  // Keeps the allocated memory.
  void clear() {
    messages_.clear();
    bytes_.clear();
  }

  // Calls f(at, channel, message) with each, in order.
  template <class F>
  void for_each(const F& f) const {
    std::size_t begin = 0;
    for (const Message& message : messages_) {
      f(message.at, message.channel, std::span(bytes_).subspan(begin, message.end - begin));
      begin = message.end;
    }
  }

 private:
  struct Message {
    SimTime at;
    std::string channel;
    std::size_t end;  // end of its bytes; they begin where those of the previous message end
  };

  std::vector<Message> messages_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace halocline::bus
