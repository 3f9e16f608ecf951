// SPDX-License-Identifier: BSD-3-Clause
// LCM log of a lockstep run, in the order and with the instants of the run.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "bus/logs/log_recorder.h"
#include "bus/messages/messages.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class LockstepLog {
 public:
  // Opens no file yet. `path` empty: nothing is recorded.
  explicit LockstepLog(std::string path) : path_(std::move(path)) {}

  // Replaces the file; throws InvalidArgument when it cannot be written. Later calls have no effect. Call it
  // only after the journal was found to belong to this scenario, so that a refused journal leaves the log
  // unchanged.
  void open();
  // Opens the log if necessary, and records the message.
  void record(const lockstep_message_t& message);
  // Throws std::runtime_error when the disk refused any message.
  void close();

 private:
  std::string path_;
  std::optional<bus::LogRecorder> recorder_;
};

}  // namespace halocline::conductor
