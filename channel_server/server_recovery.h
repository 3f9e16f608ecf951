// SPDX-License-Identifier: BSD-3-Clause
// The recovery of a channel server that was killed: the steps that it does again, and the waits on the way.
//
// The journal holds the inputs and outputs of the last minute (bus/runtime/crash_journal.h). The steps of
// that time are done again, from their inputs: decisions depend on contents and instants alone, so they are
// the same. The last step is the present one: it takes what was published while the server was away, once
// repair had its time. Two things take wall time: that, and the seabed under the links, which is queried
// anew.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "bus/runtime/crash_journal.h"
#include "bus/runtime/node.h"
#include "channel_server/inbox.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class ServerRecovery {
 public:
  // Opens the journal at `path` and takes the replayed inputs out of the inbox. Both must outlive it. Throws
  // InvalidArgument when the file cannot be written.
  ServerRecovery(bus::CrashJournal& journal, Inbox& inbox, const std::string& path, std::uint64_t digest);

  // Whether an earlier incarnation left something.
  bool has_history() const { return !steps_.empty(); }
  // False when that belongs to another run.
  [[nodiscard]] bool begin(const bus::Now& now);
  bool has_begun() const { return begun_; }

  // The instant up to which the medium advances before the next step.
  SimTime reached() const { return reached_; }
  // The inputs of the next step, at reached() then; empty while repair is given its time, and after the last.
  [[nodiscard]] std::optional<StepInputs> next_step(const bus::Now& now);
  // The present step was taken.
  bool is_done() const { return took_present_ && steps_.empty(); }

  // Steady time at which the wait for repair ends; never() without one.
  SimTime due() const { return due_; }

 private:
  struct Step {
    SimTime at;
    StepInputs inputs;
  };

  bus::CrashJournal& journal_;
  Inbox& inbox_;
  std::deque<Step> steps_;
  SimTime reached_;
  SimTime repair_ends_, due_ = SimTime::never();  // steady
  bool begun_ = false, took_present_ = false;
};

}  // namespace halocline::channel_server
