// SPDX-License-Identifier: BSD-3-Clause
// State of a vehicle: pose, velocity and actuator positions; and its commands.
//
// Frames and units are given at each field. Plain values, copied freely.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/archive.h"
#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

enum class DropWeightState : std::int64_t { kHeld, kReleased };  // avoids padding after doubles

// Fins, propeller and thrusters, as commanded or as they are. A positive rudder turns to starboard (positive
// yaw rate), positive stern planes push the bow down, a positive propeller speed drives ahead, a positive
// thruster speed pushes the hull along the thruster's direction, a positive volume of the buoyancy engine
// lifts the vehicle, and a moving mass forward pitches the bow down. A released weight stays released,
// whatever is commanded.
struct ActuatorValues {
  double rudder_rad = 0;
  double stern_planes_rad = 0;
  double propeller_hz = 0;                             // revolutions per second
  std::array<double, kMaxThrusters> thruster_hz = {};  // in the model's order; 0 for unused ones
  double buoyancy_m3 = 0;
  double moving_mass_m = 0;
  DropWeightState weight = DropWeightState::kHeld;

  bool operator==(const ActuatorValues&) const = default;
};

inline bool is_finite(const ActuatorValues& a) {
  return std::isfinite(a.rudder_rad) && std::isfinite(a.stern_planes_rad) && std::isfinite(a.propeller_hz) &&
         std::isfinite(a.buoyancy_m3) && std::isfinite(a.moving_mass_m) &&
         std::all_of(a.thruster_hz.begin(), a.thruster_hz.end(), [](double n) { return std::isfinite(n); });
}

struct VehicleState {
  Vec3 position_ned_m = Vec3::Zero();               // CO, the body's origin
  Quaternion orientation = Quaternion::Identity();  // rotation from body to world, unit
  Vec6 velocity_body = Vec6::Zero();                // over ground at CO: (u, v, w) m/s, (p, q, r) rad/s
  ActuatorValues actuators;                         // actual actuator positions and speeds

  auto linear_velocity_body_mps() const { return velocity_body.head<3>(); }
  auto angular_velocity_body_radps() const { return velocity_body.tail<3>(); }
  void archive(Archive& a) { a(position_ned_m, orientation, velocity_body, actuators); }
};

// Water around a vehicle over a step.
struct Water {
  Vec3 current_ned_mps = Vec3::Zero();  // at the start of the step, uniform over the hull, finite
  // z of the sea surface in the world frame, m; minus infinity: water without a surface. Where the surface
  // slopes, this is z of its tangent plane at the vehicle, continued to the world's origin.
  double sea_surface_z_m = -std::numeric_limits<double>::infinity();
  Vec3 current_rate_ned_mps2 = Vec3::Zero();  // acceleration of the water during the step, finite
  Vec3 surface_slope = Vec3::Zero();          // dz/dnorth and dz/deast of the surface, and 0; finite
  double surface_rate_mps = 0;                // rate of change of sea_surface_z_m during the step, finite
};

// Returns z of the surface above or below a point.
inline double surface_z_at(const Water& water, const Vec3& point_ned_m) {
  return water.sea_surface_z_m + water.surface_slope.dot(point_ned_m);
}

// False when any number of the state is NaN or infinite.
inline bool is_finite(const VehicleState& s) {
  return s.position_ned_m.allFinite() && s.orientation.coeffs().allFinite() && s.velocity_body.allFinite() &&
         is_finite(s.actuators);
}

// Pose and velocity as the KinematicState that all programs share.
inline KinematicState to_kinematic_state(const VehicleState& s) {
  return {{s.position_ned_m, s.orientation},
          s.orientation * Vec3(s.linear_velocity_body_mps()),
          s.angular_velocity_body_radps()};
}

}  // namespace halocline::vehicle_sim
