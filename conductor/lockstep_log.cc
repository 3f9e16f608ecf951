// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/lockstep_log.h"

namespace halocline::conductor {

void LockstepLog::open() {
  if (!recorder_ && !path_.empty()) recorder_.emplace(path_);
}

void LockstepLog::record(const lockstep_message_t& message) {
  open();
  if (recorder_)
    recorder_->record(SimTime::from_nanoseconds(message.instant_ns), message.channel_name,
                      message.message_bytes);
}

void LockstepLog::close() {
  if (recorder_) recorder_->close();
}

}  // namespace halocline::conductor
