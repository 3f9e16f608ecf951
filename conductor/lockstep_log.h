// SPDX-License-Identifier: BSD-3-Clause
// The LCM log of a lockstep run, in the order and with the instants of the run.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "bus/logs/log_recorder.h"
#include "bus/messages.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class LockstepLog {
 public:
  // Touches no file. `path` empty: nothing is recorded.
  explicit LockstepLog(std::string path) : path_(std::move(path)) {}

  // Replaces the file, once; throws InvalidArgument when it cannot be written. Not before the journal has
  // proved to be of this scenario: a refused one leaves the log as it was.
  void open();
  // Opens the log before the first message.
  void record(const lockstep_message_t& message);
  // Throws std::runtime_error when the disk refused any of it.
  void close();

 private:
  std::string path_;
  std::optional<bus::LogRecorder> recorder_;
};

}  // namespace halocline::conductor
