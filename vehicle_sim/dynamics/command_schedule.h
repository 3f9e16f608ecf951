// SPDX-License-Identifier: BSD-3-Clause
// Schedule of a vehicle's commands: each holds from its own time on, until a later one holds or the time-out
// passes; then the vehicle is in its safe state.
//
// In the safe state (safe_state) a vehicle slows down and drifts; one that is buoyant (the scenario's
// buoyancy_over_weight above 1) or has a buoyancy engine rises to the surface. A vehicle that has had no
// command is in the safe state, too. The command at an instant does not depend on the order in which commands
// with different times were received.
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
  kTooOld,   // older than the time-out, or than a command that already held
  kTooMany,  // more commands wait for their time than a pilot needs
};

class CommandSchedule {
 public:
  static constexpr std::size_t kMaxWaiting = 1000;

  // `timeout`, above 0: age beyond which a command no longer holds and `safe` takes its place.
  explicit CommandSchedule(SimDuration timeout, const ActuatorValues& safe = {});

  // Schedules a command received at `now`. Of two commands with the same time the one received later counts.
  [[nodiscard]] CommandVerdict add(const TimedCommand& command, SimTime now);

  // Returns the command that holds at `now`; `now` must not decrease between calls.
  ActuatorValues at(SimTime now);

  // True when the last at() returned the safe state because no command held.
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
