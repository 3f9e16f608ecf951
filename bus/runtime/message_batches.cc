// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/message_batches.h"

namespace halocline::bus {

SimDuration MessageBatches::wait_at(SimTime steady) {
  if (const SimDuration passed = steady - window_begins_; passed >= kWindow) {
    // Over a window that lasted longer because nothing came.
    is_busy_ = messages_ * kWindow.seconds() >= kBusy * passed.seconds();
    window_begins_ = steady;
    messages_ = 0;
  }
  return is_busy_ ? kBatch : SimDuration();
}

}  // namespace halocline::bus
