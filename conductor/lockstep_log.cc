#include "conductor/lockstep_log.h"

namespace halocline::conductor {

void LockstepLog::open() {
  if (!recorder_ && !path_.empty()) recorder_.emplace(lcm_, path_, [this] { return stamp_; });
}

void LockstepLog::record(const lockstep_message_t& message) {
  open();
  if (!recorder_) return;
  stamp_ = SimTime::from_nanoseconds(message.instant_ns);
  lcm_.publish(message.channel_name, message.message_bytes.data(),
               static_cast<unsigned int>(message.message_bytes.size()));
  lcm_.handleTimeout(0);
}

void LockstepLog::close() {
  if (recorder_) recorder_->close();
}

}  // namespace halocline::conductor
