// SPDX-License-Identifier: BSD-3-Clause
// Pace of a lockstep run: simulation time may advance at most by the wall time since the run began, or was
// resumed, times a rate.
#pragma once

#include <optional>

#include "bus/lockstep/lockstep_conductor.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class LockstepPace {
 public:
  // `rate`: simulated seconds per wall second; 0: the run is not paced.
  explicit LockstepPace(double rate) : rate_(rate) {}

  // Sets the pace of `conductor`: simulation time 0 before its first round.
  void keep(LockstepConductor& conductor, SimTime steady);
  // Steady time of the next call of keep(); never() if the run is not paced.
  SimTime next_due() const { return next_due_; }

 private:
  struct Origin {
    SimTime steady, simulation;
  };

  double rate_;
  std::optional<Origin> origin_;
  SimTime next_due_ = SimTime::never();
};

}  // namespace halocline::conductor
