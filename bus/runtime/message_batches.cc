// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/message_batches.h"

#include "bus/recovery/crash_journal.h"

namespace halocline::bus {

SimDuration MessageBatches::wait_at(SimTime steady) {
  if (const SimDuration passed = steady - window_begins_; passed >= kWindow) {
    // Rate over the window; it lasted longer than kWindow if no message came.
    is_busy_ = messages_ * kWindow.seconds() >= kBusy * passed.seconds();
    window_begins_ = steady;
    messages_ = 0;
  }
  return is_busy_ ? kBatch : SimDuration();
}

void Halt::look(SimTime steady, SimDuration used, bool waits, bool misses) {
  constexpr SimDuration kHalted = SimDuration::from_milliseconds(1000);  // the loop sleeps at most 0.1 s
  // A message that nobody can repair must not hold the node for long.
  constexpr SimDuration kLongest = SimDuration::from_milliseconds(3000);
  const SimDuration idle = (steady - looked_) - (used - used_);
  looked_ = steady;
  used_ = used;
  if (idle > kHalted && waits) since_ = steady;
  if (!since_) return;
  const SimDuration held = steady - *since_;
  if (held >= kLongest || (held >= CrashJournal::kRepairTime && !misses)) since_.reset();
}

}  // namespace halocline::bus
