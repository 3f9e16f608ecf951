// SPDX-License-Identifier: BSD-3-Clause
// The recovery of a channel server that was killed: the steps that are redone, and the waits on the way.
//
// The journal holds the inputs and outputs of the last minute (bus/recovery/crash_journal.h). The steps of
// that time are redone from their inputs. Decisions depend on contents and instants alone, so they are the
// same. The last step is the present one: it takes the messages that were published while the server was
// down, once they have been repaired. Two things take wall time: this repair, and the seabed under the links,
// which is queried again.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "bus/recovery/crash_journal.h"
#include "bus/runtime/node.h"
#include "channel_server/inbox.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class ServerRecovery {
 public:
  // Opens the journal at `path` and takes the replayed inputs out of the inbox. Journal and inbox must
  // outlive this object. Throws InvalidArgument when the file cannot be written.
  ServerRecovery(bus::CrashJournal& journal, Inbox& inbox, const std::string& path, std::uint64_t digest);

  // True when an earlier incarnation left steps in the journal.
  bool has_history() const { return !steps_.empty(); }
  // Begins the recovery; returns false when the recorded steps belong to another run.
  [[nodiscard]] bool begin(const bus::Now& now);
  bool has_begun() const { return begun_; }

  // Returns the instant up to which the medium advances before the next step.
  SimTime reached() const { return reached_; }
  // Returns the inputs of the next step, and sets reached() to its instant; empty while the repair of missed
  // messages is given its time, and after the last step.
  [[nodiscard]] std::optional<StepInputs> next_step(const bus::Now& now);
  // True when the present step has been taken.
  bool is_done() const { return took_present_ && steps_.empty(); }

  // Returns the steady time at which the wait for repair ends; never() without a wait.
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
