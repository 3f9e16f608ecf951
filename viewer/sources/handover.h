// SPDX-License-Identifier: BSD-3-Clause
// Bounded queue of messages from the thread that receives the bus to the one that shows them. Messages that
// do not fit are dropped and counted, so that the receiver never waits. Thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace halocline::monitor {

struct BusMessage {
  std::int64_t stamp_us = 0;  // wall time of reception
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

class Handover {
 public:
  static constexpr std::size_t kMaxBytes = 64 * 1024 * 1024, kMaxMessages = 200'000;

  void put(std::vector<BusMessage> messages) {
    const std::lock_guard lock(mutex_);
    for (BusMessage& message : messages) {
      const std::size_t size = message.bytes.size() + message.channel.size();
      if (bytes_ + size > kMaxBytes || waiting_.size() >= kMaxMessages) {
        ++dropped_;
        continue;
      }
      bytes_ += size;
      waiting_.push_back(std::move(message));
    }
  }
  std::vector<BusMessage> take() {
    const std::lock_guard lock(mutex_);
    bytes_ = 0;
    return std::exchange(waiting_, {});
  }
  std::int64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<BusMessage> waiting_;
  std::size_t bytes_ = 0;
  std::int64_t dropped_ = 0;
};

}  // namespace halocline::monitor
