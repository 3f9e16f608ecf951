// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/state_selection.h"

#include "core/state_extrapolation.h"

namespace halocline::vehicle_sim {

bool StateSelection::strays(const StateRule& rule, const Published& from, SimTime when,
                            const KinematicState& state) {
  const Pose reckoned_pose = reckoned(from.state, when - from.when).pose;
  const double off_m = (state.pose.position_ned_m - reckoned_pose.position_ned_m).norm();
  return off_m > rule.deviation_m ||
         angle_between(reckoned_pose.orientation, state.pose.orientation) > rule.deviation_rad;
}

bool StateSelection::take(const StateRule& rule, SimDuration period, SimTime when,
                          const KinematicState& state) {
  const bool is_due = rule.deviation_m == 0 || !last_ || when + period - last_->when > rule.longest_silence ||
                      strays(rule, *last_, when, state);
  if (is_due) last_ = {when, state};
  return is_due;
}

void StateSelection::Published::archive(Archive& a) {
  a(when, state.pose.position_ned_m, state.pose.orientation, state.velocity_ned_mps,
    state.angular_velocity_body_radps);
}

}  // namespace halocline::vehicle_sim
