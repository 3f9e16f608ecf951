// SPDX-License-Identifier: BSD-3-Clause
// Dead reckoning: position and attitude of a vehicle between its states. Receivers of STATE extrapolate the
// last state by this rule, and the vehicle simulator decides by it when the next one is needed.
//
// Linear velocity is constant in the world frame, and angular velocity in the body frame: R(P, W) of IEEE
// 1278.1. Over a time h with an acceleration a the position error is at most
//
//   a h^2 / 2
#pragma once

#include "core/elementary.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline {

// Position x + v t in world NED, m; velocity in m/s. `since` may be negative.
inline Vec3 reckoned_position(const Vec3& position_ned_m, const Vec3& velocity_ned_mps, SimDuration since) {
  return position_ned_m + since.seconds() * velocity_ned_mps;
}

// Extrapolates a state by `since`; if that is 0, the state is returned unchanged to the last bit.
inline KinematicState reckoned(const KinematicState& state, SimDuration since) {
  if (since == SimDuration()) return state;
  KinematicState later = state;
  later.pose.position_ned_m = reckoned_position(state.pose.position_ned_m, state.velocity_ned_mps, since);
  later.pose.orientation =
      state.pose.orientation * rotation_by(since.seconds() * state.angular_velocity_body_radps);
  return later;
}

// Angle of the rotation from one attitude to the other, rad, 0 to pi.
inline double angle_between(const Quaternion& a, const Quaternion& b) {
  const Quaternion way = a.conjugate() * b;
  return 2 * elementary::atan2(way.vec().norm(), way.w() < 0 ? -way.w() : way.w());
}

}  // namespace halocline
