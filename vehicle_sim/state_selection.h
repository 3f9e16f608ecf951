// SPDX-License-Identifier: BSD-3-Clause
// Which states of a vehicle are published where its receivers reckon between them (core/dead_reckoning.h):
// the states from which the reckoning has strayed, and one now and then (thresholds and heartbeat of IEEE
// 1278.1).
//
// A state is published at a tick of the state grid when the reckoning from the last one published is off by
// more than a bound, in place or in attitude, or when otherwise the next tick would lie more than
// `longest_silence` after that one.
//
// Guarantee. At each tick whoever has the states published so far is off by no more than the bounds. In
// between, and until a state published at a tick arrives d later, the error of the place grows by at most |v
// - u| (T + d): v the velocity, u that of the state reckoned from, T the period of the ticks. The velocity
// itself has no bound of its own.
#pragma once

#include <optional>

#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::vehicle_sim {

struct StateRule {
  double deviation_m = 0;                                             // 0 and up; 0: each state is published
  double deviation_rad = to_radians(1);                               // above 0
  SimDuration longest_silence = SimDuration::from_milliseconds(500);  // above 0
};

// Of one vehicle: its last published state.
class StateSelection {
 public:
  // Whether its state at `when`, a tick, is published; then it is the one to reckon from. `period`: to the
  // next tick.
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
