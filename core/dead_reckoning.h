// SPDX-License-Identifier: BSD-3-Clause
// Where a vehicle is between its states: the rule by which whoever receives STATE carries the last one on,
// and by which the vehicle simulator decides when the next one is needed.
//
// Linear velocity is constant in the world frame, angular velocity in the body frame: the dead reckoning R(P,
// W) of IEEE 1278.1. Its error over a time h is at most a h^2 / 2 at an acceleration a.
#pragma once

#include "core/elementary.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline {

// World NED, m and m/s; `since` may be negative.
inline Vec3 reckoned_position(const Vec3& position_ned_m, const Vec3& velocity_ned_mps, SimDuration since) {
  return position_ned_m + since.seconds() * velocity_ned_mps;
}

// The state itself, to the last bit, where `since` is 0.
inline KinematicState reckoned(const KinematicState& state, SimDuration since) {
  if (since == SimDuration()) return state;
  KinematicState later = state;
  later.pose.position_ned_m = reckoned_position(state.pose.position_ned_m, state.velocity_ned_mps, since);
  later.pose.orientation =
      state.pose.orientation * rotation_by(since.seconds() * state.angular_velocity_body_radps);
  return later;
}

// The angle of the rotation from one attitude to the other, radians, 0 to pi.
inline double angle_between(const Quaternion& a, const Quaternion& b) {
  const Quaternion way = a.conjugate() * b;
  return 2 * elementary::atan2(way.vec().norm(), way.w() < 0 ? -way.w() : way.w());
}

}  // namespace halocline
