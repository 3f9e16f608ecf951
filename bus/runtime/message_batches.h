// SPDX-License-Identifier: BSD-3-Clause
// How long a node that is woken by a message lets more of them gather: where many come, a wake-up for each
// costs more than the messages.
//
// Rule: interrupt moderation (Mogul and Ramakrishnan 1997, "Eliminating receive livelock in an
// interrupt-driven kernel"). Where the last whole window of kWindow had kBusy messages or more, a batch of
// kBatch is taken; otherwise every message at once. So a message of a busy bus is handled up to kBatch later,
// far less than the lag of positions (docs/architecture.md).
#pragma once

#include <optional>

#include "core/sim_time.h"

namespace halocline::bus {

class MessageBatches {
 public:
  static constexpr SimDuration kWindow = SimDuration::from_milliseconds(20);
  static constexpr int kBusy = 60;  // 3000 a second
  static constexpr SimDuration kBatch = SimDuration::from_milliseconds(1);

  // How long messages may gather when the first of them has come at `steady`; times do not go back.
  SimDuration wait_at(SimTime steady);
  // So many were handled, since the last call.
  void note_handled(int messages) { messages_ += messages; }

 private:
  SimTime window_begins_;
  int messages_ = 0;  // since then
  bool is_busy_ = false;
};

// Notices that the process was halted (SIGSTOP, a debugger, a machine that slept or had no processor for it),
// so that its socket may have run over, and holds a node until repair has brought what it missed.
class Halt {
 public:
  // `used`: processor time of the process so far.
  Halt(SimTime steady, SimDuration used) : looked_(steady), used_(used) {}
  // To be called in each turn of the loop. `waits`: the node waits for repair; `misses`: messages are
  // missing.
  void look(SimTime steady, SimDuration used, bool waits, bool misses);
  bool holds() const { return since_.has_value(); }

 private:
  SimTime looked_;
  SimDuration used_;
  std::optional<SimTime> since_;  // steady
};

}  // namespace halocline::bus
