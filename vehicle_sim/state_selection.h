// SPDX-License-Identifier: BSD-3-Clause
// Selection of the vehicle states to publish when receivers extrapolate between them
// (core/state_extrapolation.h): by deviation thresholds and a heartbeat, as in IEEE 1278.1.
//
// At a tick of the state grid, a state is published when the extrapolation of the last published one differs
// from it by more than a bound, in position or in attitude, or when the next tick would otherwise be more
// than `longest_silence` after the last published one.
//
// Guarantee: at each tick the error of a receiver that has all states published so far is within the bounds.
// Between ticks, and until a state that is published at a tick arrives d later, the position error grows by
// at most
//
//   |v - u| (T + d)
//
// with v the velocity, u that of the last published state and T the period of the ticks. The velocity has no
// bound of its own.
#pragma once

#include <optional>

#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::vehicle_sim {

struct StateRule {
  double deviation_m = 0;                                             // 0 or above; 0: publish every state
  double deviation_rad = to_radians(1);                               // above 0
  SimDuration longest_silence = SimDuration::from_milliseconds(500);  // above 0
};

// Selection for one vehicle, with its last published state.
class StateSelection {
 public:
  // Returns true when `state` at `when`, a tick, is to be published, and then extrapolates from it. `period`:
  // time to the next tick.
  [[nodiscard]] bool take(const StateRule& rule, SimDuration period, SimTime when,
                          const KinematicState& state);

  void archive(Archive& a) { a(last_); }

 private:
  struct Published {
    SimTime when;
    KinematicState state;
    void archive(Archive& a);
  };
  static bool strays(const StateRule& rule, const Published& from, SimTime when, const KinematicState& state);

  std::optional<Published> last_;
};

}  // namespace halocline::vehicle_sim
