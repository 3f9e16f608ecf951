// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/publication_pace.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace halocline::bus {

SimDuration PublicationPace::wait_before(std::size_t bytes, SimTime steady) {
  const double passed_s = std::max((steady - filled_at_).seconds(), 0.0);
  filled_at_ = std::max(filled_at_, steady);
  // Token buckets: tokens = min(tokens + rate * time, burst).
  messages_ = std::min(messages_ + passed_s * kMessagesPerS, kBurstMessages);
  bytes_ = std::min(bytes_ + passed_s * kBytesPerS, kBurstBytes);
  const double size = static_cast<double>(bytes);
  SimDuration wait;
  // A message larger than the bucket of bytes is sent as soon as that bucket is full.
  if (messages_ < 1 || bytes_ < std::min(size, kBurstBytes)) {
    wait = SimDuration::from_seconds(
        std::max((kBurstMessages - messages_) / kMessagesPerS, (kBurstBytes - bytes_) / kBytesPerS));
    filled_at_ = filled_at_ + wait;
    messages_ = kBurstMessages;
    bytes_ = kBurstBytes;
  }
  messages_ -= 1;
  bytes_ -= size;
  return wait;
}

void PublicationPace::wait(std::size_t bytes) {
  using std::chrono::nanoseconds;
  const nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
  const SimDuration before = wait_before(bytes, SimTime::from_nanoseconds(now.count()));
  if (before > SimDuration()) std::this_thread::sleep_for(nanoseconds(before.nanoseconds()));
}

}  // namespace halocline::bus
