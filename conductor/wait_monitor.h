// SPDX-License-Identifier: BSD-3-Clause
// Detects that a lockstep run stands still, and which participants it waits for.
#pragma once

#include <cstdint>
#include <string>

#include "bus/lockstep/lockstep_conductor.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class WaitMonitor {
 public:
  // Steady time without a turn after which a wait is overdue, and between repeated reports.
  static constexpr SimDuration kPeriod = SimDuration::from_milliseconds(5000);

  // Returns the participants waited for, separated by commas, once a period; otherwise an empty text.
  [[nodiscard]] std::string overdue(const LockstepConductor& conductor, SimTime steady);

 private:
  std::int64_t turns_before_ = 0;
  SimTime next_due_ = SimTime() + kPeriod;
};

}  // namespace halocline::conductor
