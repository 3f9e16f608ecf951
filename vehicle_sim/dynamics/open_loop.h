// SPDX-License-Identifier: BSD-3-Clause
// A vehicle run along a schedule of commands and sampled: what the reference trajectories are made of.
//
// Solves equations_of_motion.h by steps on the grid of `step` from time 0, cut where a command or a sample
// falls between. The vehicle is free: no ground. A weight is gone from the step after its release on. Given
// the same run the same numbers come out. Pure; any number of threads.
#pragma once

#include <stdexcept>
#include <vector>

#include "core/sim_time.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

// From `from` on, until the next one.
struct ScheduledCommand {
  SimTime from;
  ActuatorValues actuators;
};

struct OpenLoopRun {
  VehicleState start;                      // at time 0
  std::vector<ScheduledCommand> schedule;  // times rising; before the first all commands are 0
  Water water;
  SimDuration duration;                                              // 0 or above
  SimDuration step = SimDuration::from_milliseconds(10);             // 0.1 to 20 ms
  SimDuration sample_period = SimDuration::from_milliseconds(1000);  // above 0
};

struct OpenLoopSample {
  SimTime time;
  VehicleState state;
  double yaw_unwrapped_rad = 0;  // continuous from the start's yaw in -pi to pi
  ActuatorValues command;        // that holds from this instant on, as given
};

// The state was no longer finite: the step is too long for the model, or its coefficients are impossible.
class Diverged : public std::runtime_error {
 public:
  explicit Diverged(SimTime at);
  SimTime at() const { return at_; }  // the end of the step that had no finite result

 private:
  SimTime at_;
};

// One sample at 0 and one each period to the end of the duration. Commands are held to the model's limits:
// see without_limits. Throws InvalidArgument where a field is out of its range, Diverged where there is no
// more result.
std::vector<OpenLoopSample> run_open_loop(const Model& model, const OpenLoopRun& run);

// The same vehicle with actuators without limits (fins to a right angle).
ModelParameters without_limits(ModelParameters parameters);

}  // namespace halocline::vehicle_sim
