// SPDX-License-Identifier: BSD-3-Clause
// Open-loop run: moves a vehicle by a schedule of commands and samples its state, for the reference
// trajectories.
//
// It integrates equations_of_motion.h by steps on the grid of `step` from time 0, split where a command or a
// sample falls inside one. The vehicle is free: there is no seabed. A drop weight is gone from the step after
// its release. The results are the same for the same run. Pure, safe in any number of threads.
#pragma once

#include <stdexcept>
#include <vector>

#include "core/sim_time.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

// Command that holds from the instant `from` to the next one in the schedule.
struct ScheduledCommand {
  SimTime from;
  ActuatorValues actuators;
};

struct OpenLoopRun {
  VehicleState start;                      // state at time 0
  std::vector<ScheduledCommand> schedule;  // in ascending order of time; before the first all commands are 0
  Water water;
  SimDuration duration;                                              // 0 or above
  SimDuration step = SimDuration::from_milliseconds(10);             // 0.1 to 20 ms
  SimDuration sample_period = SimDuration::from_milliseconds(1000);  // above 0
};

struct OpenLoopSample {
  SimTime time;
  VehicleState state;
  double yaw_unwrapped_rad = 0;  // continuous, from the yaw at the start in -pi to pi
  ActuatorValues command;        // command that holds from this instant on, before limits
};

// Thrown when the state is no longer finite: the step is too long for the model, or a coefficient is
// impossible.
class Diverged : public std::runtime_error {
 public:
  explicit Diverged(SimTime at);
  SimTime at() const { return at_; }  // end of the step that had no finite result

 private:
  SimTime at_;
};

// Returns one sample at time 0 and one each period up to the duration. Commands are limited to the model's
// ranges unless they come from without_limits. Throws InvalidArgument when a field is out of its range, and
// Diverged when the state is no longer finite.
std::vector<OpenLoopSample> run_open_loop(const Model& model, const OpenLoopRun& run);

// Returns the same vehicle with actuators without limits (fins up to a right angle).
ModelParameters without_limits(ModelParameters parameters);

}  // namespace halocline::vehicle_sim
