// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/command_schedule.h"

#include <algorithm>

#include "core/check.h"

namespace halocline::vehicle_sim {

CommandSchedule::CommandSchedule(SimDuration timeout, const ActuatorValues& safe)
    : timeout_(timeout), safe_state_(safe) {
  require(timeout > SimDuration(), "the command time-out must be positive");
}

CommandVerdict CommandSchedule::add(const TimedCommand& command, SimTime now) {
  if (command.from < now - timeout_) return CommandVerdict::kTooOld;
  if (commanded_ && command.from < obeyed_.from) return CommandVerdict::kTooOld;
  if (waiting_.size() >= kMaxWaiting) return CommandVerdict::kTooMany;
  const auto later = [](const TimedCommand& a, const TimedCommand& b) { return a.from < b.from; };
  waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), command, later), command);
  return CommandVerdict::kTaken;
}

ActuatorValues CommandSchedule::at(SimTime now) {
  std::size_t reached = 0;
  while (reached < waiting_.size() && waiting_[reached].from <= now) ++reached;
  if (reached > 0) {
    obeyed_ = waiting_[reached - 1];
    commanded_ = true;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(reached));
  }
  safe_ = !commanded_ || now - obeyed_.from > timeout_;
  return safe_ ? safe_state_ : obeyed_.actuators;
}

}  // namespace halocline::vehicle_sim
