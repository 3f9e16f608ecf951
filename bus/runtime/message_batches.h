// SPDX-License-Identifier: BSD-3-Clause
// Batching of messages: how long a node that was woken by a message waits for more. On a busy bus a wake-up
// for each message costs more than the messages themselves.
//
// The rule is interrupt moderation (Mogul and Ramakrishnan 1997, "Eliminating receive livelock in an
// interrupt-driven kernel"). If the last complete window of kWindow had kBusy messages or more, messages are
// collected for kBatch; otherwise each is handled at once. A message on a busy bus is thus handled up to
// kBatch later, far less than the lag of positions (docs/architecture.md).
#pragma once

#include <optional>

#include "core/sim_time.h"

namespace halocline::bus {

class MessageBatches {
 public:
  static constexpr SimDuration kWindow = SimDuration::from_milliseconds(20);
  static constexpr int kBusy = 60;  // messages in a window: 3000 a second
  static constexpr SimDuration kBatch = SimDuration::from_milliseconds(1);

  // Returns how long to wait for more messages when the first has arrived at `steady`; times do not decrease.
  SimDuration wait_at(SimTime steady);
  // Records how many messages were handled since the last call.
  void note_handled(int messages) { messages_ += messages; }

 private:
  SimTime window_begins_;
  int messages_ = 0;  // since the window began
  bool is_busy_ = false;
};

// Detector of halts of the process (SIGSTOP, a debugger, a machine that slept or gave it no processor), in
// which its socket may have overflowed. It holds the node until repair has delivered the missing messages.
class Halt {
 public:
  // `used`: processor time of the process so far.
  Halt(SimTime steady, SimDuration used) : looked_(steady), used_(used) {}
  // Call it in each turn of the loop. `waits`: the node waits for repair; `misses`: messages are missing.
  void look(SimTime steady, SimDuration used, bool waits, bool misses);
  bool holds() const { return since_.has_value(); }

 private:
  SimTime looked_;
  SimDuration used_;
  std::optional<SimTime> since_;  // steady
};

}  // namespace halocline::bus
