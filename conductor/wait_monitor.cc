// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/wait_monitor.h"

namespace halocline::conductor {

std::string WaitMonitor::overdue(const LockstepConductor& conductor, SimTime steady) {
  const std::int64_t turns = conductor.sequencer().turns();
  if (turns != turns_before_) {
    turns_before_ = turns;
    next_due_ = steady + kPeriod;
  }
  if (steady < next_due_) return {};
  next_due_ = steady + kPeriod;
  std::string names;
  for (const std::string& name : conductor.waiting_for()) names += (names.empty() ? "" : ",") + name;
  return names;
}

}  // namespace halocline::conductor
