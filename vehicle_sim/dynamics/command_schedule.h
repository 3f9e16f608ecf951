// SPDX-License-Identifier: BSD-3-Clause
// Schedule of a vehicle's commands: each holds from its own time on, until a later one, or until the
// time-out; then the vehicle is in its safe state.
//
// Safe state (safe_state): a vehicle without a pilot slows down and drifts; one that is buoyant (the
// scenario's buoyancy_over_weight above 1) or has a buoyancy engine comes up. A vehicle that was never
// commanded is in it too. The command at an instant does not depend on the order in which commands with
// different times came.
#pragma once

#include <cstddef>
#include <vector>

#include "core/archive.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

struct TimedCommand {
  SimTime from;  // holds from this instant on
  ActuatorValues actuators;
};

enum class CommandVerdict {
  kTaken,
  kTooOld,   // older than the time-out, or than a command already obeyed
  kTooMany,  // more wait for their time than a pilot needs
};

class CommandSchedule {
 public:
  static constexpr std::size_t kMaxWaiting = 1000;

  // `timeout` above 0: the age at which a command is no longer obeyed, but `safe` is.
  explicit CommandSchedule(SimDuration timeout, const ActuatorValues& safe = {});

  // Schedules a command received at `now`. Of two for one instant the one received later counts.
  [[nodiscard]] CommandVerdict add(const TimedCommand& command, SimTime now);

  // The command that holds at `now`; calls must not go back in time.
  ActuatorValues at(SimTime now);

  // True when the last at() gave the safe state for want of a command.
  bool is_safe_state() const { return safe_; }

  void archive(Archive& a) { a(obeyed_, waiting_, commanded_, safe_); }

 private:
  SimDuration timeout_;
  ActuatorValues safe_state_;
  TimedCommand obeyed_{SimTime::at_once(), {}};
  std::vector<TimedCommand> waiting_;  // ascending in time
  bool commanded_ = false;             // obeyed_ holds a command
  bool safe_ = true;
};

}  // namespace halocline::vehicle_sim
