// SPDX-License-Identifier: BSD-3-Clause
// Notices that a lockstep run stands still, and for whom.
#pragma once

#include <cstdint>
#include <string>

#include "bus/lockstep/lockstep_conductor.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class WaitMonitor {
 public:
  // Steady time without a turn after which, and between whose repetitions, a wait is overdue.
  static constexpr SimDuration kPeriod = SimDuration::from_milliseconds(5000);

  // The participants waited for, separated by commas, once a period; else empty.
  [[nodiscard]] std::string overdue(const LockstepConductor& conductor, SimTime steady);

 private:
  std::int64_t turns_before_ = 0;
  SimTime next_due_ = SimTime() + kPeriod;
};

}  // namespace halocline::conductor
