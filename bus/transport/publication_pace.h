// SPDX-License-Identifier: BSD-3-Clause
// Limit on the rate of publication on a bus that loses datagrams: the buffer of a receiver that is scheduled
// late must hold the messages that arrive meanwhile.
//
// The rule is a token bucket for messages and one for bytes (Turner 1986, "New directions in
// communications"). A burst of kBurstMessages and kBurstBytes is sent at once, further messages at
// kMessagesPerS and kBytesPerS. LCM's logger queues 30 messages, the kernel 4 MB (docs/architecture.md). A
// publisher that has to wait waits until both buckets are full again, so that few sleeps suffice.
#pragma once

#include <cstddef>

#include "core/sim_time.h"

namespace halocline::bus {

class PublicationPace {
 public:
  static constexpr double kBurstMessages = 24, kMessagesPerS = 48'000;
  static constexpr double kBurstBytes = 1 << 20, kBytesPerS = 128 << 20;

  // Returns how long to wait, at steady time `steady`, before a message of `bytes` is published; the message
  // is then counted as published. Times do not decrease.
  SimDuration wait_before(std::size_t bytes, SimTime steady);
  // Waits for this time, by the steady clock.
  void wait(std::size_t bytes);

 private:
  SimTime filled_at_;  // time of messages_ and bytes_
  double messages_ = kBurstMessages, bytes_ = kBurstBytes;
};

}  // namespace halocline::bus
