// SPDX-License-Identifier: BSD-3-Clause
// How fast messages may follow each other on a bus that loses datagrams: a receiver that is scheduled late
// has to hold what arrives meanwhile.
//
// Rule: a token bucket for messages and one for bytes (Turner 1986, "New directions in communications"). A
// burst of kBurstMessages and kBurstBytes goes out at once, then kMessagesPerS and kBytesPerS. LCM's logger
// queues 30 messages, the kernel 4 MB (docs/bus.md). Who has to wait waits until both buckets are full again,
// so that few sleeps do.
#pragma once

#include <cstddef>

#include "core/sim_time.h"

namespace halocline::bus {

class PublicationPace {
 public:
  static constexpr double kBurstMessages = 24, kMessagesPerS = 48'000;
  static constexpr double kBurstBytes = 1 << 20, kBytesPerS = 128 << 20;

  // How long to wait, at a steady time, before a message of that size is published; it counts as published
  // then. Times do not go back.
  SimDuration wait_before(std::size_t bytes, SimTime steady);
  // Waits so long, by the steady clock.
  void wait(std::size_t bytes);

 private:
  SimTime filled_at_;  // what follows is of this time
  double messages_ = kBurstMessages, bytes_ = kBurstBytes;
};

}  // namespace halocline::bus
