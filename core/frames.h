// SPDX-License-Identifier: BSD-3-Clause
// The two coordinate frames of the project, and the pose that relates them.
//
// World frame: local NED at the scenario's geodetic origin: x north, y east, z down, m; z = 0 is the datum of
// the terrain. The depth below the sea surface is z - sea_surface_z: a tide moves the surface, not the
// vehicles. Body frame: x forward, y starboard, z down. Orientation: unit quaternion that rotates body
// coordinates to world coordinates; lists have the order w, x, y, z.
#pragma once

#include <algorithm>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/elementary.h"

namespace halocline {

using Vec3 = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

struct Pose {
  Vec3 position_ned_m = Vec3::Zero();
  Quaternion orientation = Quaternion::Identity();  // body to world
};

// A pose and its rate of change; linear velocity in the world frame, angular velocity in the body frame.
struct KinematicState {
  Pose pose;
  Vec3 velocity_ned_mps = Vec3::Zero();
  Vec3 angular_velocity_body_radps = Vec3::Zero();
};

// Roll, pitch, yaw: intrinsic z-y'-x'' (yaw about down first), radians; pitch within +-pi/2.
struct EulerAngles {
  double roll = 0, pitch = 0, yaw = 0;
};

// Returns the rotation by the angle |v|, rad, about the axis v. Eigen's AngleAxis and slerp are not used
// because they call the C library's functions.
inline Quaternion rotation_by(const Vec3& v) {
  const double angle = v.norm();
  if (angle == 0) return Quaternion::Identity();
  const auto [sine, cosine] = elementary::sin_cos(angle / 2);
  const Vec3 part = sine / angle * v;
  return {cosine, part.x(), part.y(), part.z()};
}

inline Quaternion to_quaternion(const EulerAngles& e) {
  return rotation_by(e.yaw * Vec3::UnitZ()) * rotation_by(e.pitch * Vec3::UnitY()) *
         rotation_by(e.roll * Vec3::UnitX());
}

// Interpolates from `a` (share 0) to `b` (share 1) at a constant rate along the shorter rotation.
inline Quaternion between(const Quaternion& a, const Quaternion& b, double share) {
  const Quaternion way = a.conjugate() * b;
  const double side = way.w() < 0 ? -1 : 1, sine = way.vec().norm();
  if (sine == 0) return a;
  const double angle = 2 * elementary::atan2(sine, side * way.w());
  return a * rotation_by(share * angle * side / sine * way.vec());
}

// Converts to Euler angles. At pitch = +-pi/2 roll and yaw are not unique; one of the possible pairs is
// returned.
inline EulerAngles to_euler(const Quaternion& q) {
  const Eigen::Matrix3d r = q.toRotationMatrix();
  const double sine_pitch = std::clamp(-r(2, 0), -1.0, 1.0);
  return {elementary::atan2(r(2, 1), r(2, 2)), elementary::asin(sine_pitch),
          elementary::atan2(r(1, 0), r(0, 0))};
}

// Depth below the sea surface, metres, positive down; `sea_surface_z_m` is the surface's z in the world
// frame.
inline double depth_below_surface_m(const Vec3& position_ned_m, double sea_surface_z_m) {
  return position_ned_m.z() - sea_surface_z_m;
}

}  // namespace halocline
