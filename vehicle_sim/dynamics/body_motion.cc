// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/body_motion.h"

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {
namespace {

// Returns q rotated by the rotation vector `angle`, world frame, rad.
Quaternion turned(const Quaternion& q, const Vec3& angle) { return (rotation_by(angle) * q).normalized(); }

// Returns the velocity relative to the water (Fossen 2021, section 10.3):
//
//   nu_r = nu - (R^T v_c, 0)
Vec6 relative_velocity(const VehicleState& state, const Vec3& current_ned) {
  Vec6 nu = state.velocity_body;
  nu.head<3>() -= state.orientation.conjugate() * current_ned;
  return nu;
}

// Returns the same momentum with its moment about `pivot`, r:
//
//   L_r = L - r x P
Impulse about(const Impulse& impulse, const Vec3& pivot) {
  return {impulse.linear, impulse.moment - pivot.cross(impulse.linear)};
}

// Returns momentum and moment of momentum about CO, rotated to the world frame (Fossen 2021, eq. 6.42 and
// 6.48):
//
//   (P, L) = M nu_r
Impulse momentum_about_origin_of_body(const Model& model, const VehicleState& state,
                                      const Vec3& current_ned) {
  const Vec6 momentum = model.mass() * relative_velocity(state, current_ned);
  return {state.orientation * Vec3(momentum.head<3>()), state.orientation * Vec3(momentum.tail<3>())};
}

Vec6 in_body_frame(const Quaternion& orientation, const Impulse& impulse) {
  Vec6 v;
  v << orientation.conjugate() * impulse.linear, orientation.conjugate() * impulse.moment;
  return v;
}

}  // namespace

// Rigid-body kinematics (Fossen 2021, chapter 2): v + omega x r.
Vec3 velocity_at(const Motion& cg, const Vec3& point_ned_m) {
  return cg.velocity + cg.angular_velocity.cross(point_ned_m - cg.position);
}

// Position and velocity of the centre of gravity:
//
//   p_g = p + R r_g
//   v_g = R (v + omega x r_g)
Motion motion_of_cg(const Model& model, const VehicleState& s) {
  const Vec3& r = model.parameters().center_of_gravity_m;
  const Vec3 v = s.linear_velocity_body_mps(), w = s.angular_velocity_body_radps();
  return {s.position_ned_m + s.orientation * r, s.orientation * Vec3(v + w.cross(r)), s.orientation * w};
}

void set_motion_of_cg(VehicleState& s, const Model& model, const Motion& cg) {
  const Vec3& r = model.parameters().center_of_gravity_m;
  const Quaternion to_body = s.orientation.conjugate();
  const Vec3 w = to_body * cg.angular_velocity;
  s.position_ned_m = cg.position - s.orientation * r;
  s.velocity_body << to_body * cg.velocity - w.cross(r), w;
}

// Semi-implicit Euler step, with h the step:
//
//   p_g <- p_g + h v_g
//   q   <- exp(h omega / 2) q
VehicleState moved(const Model& model, const VehicleState& from, const Motion& cg, double step_s) {
  VehicleState to = from;
  to.orientation = turned(from.orientation, step_s * cg.angular_velocity);
  set_motion_of_cg(to, model, {cg.position + step_s * cg.velocity, cg.velocity, cg.angular_velocity});
  return to;
}

VehicleState moved_freely(const Model& model, const VehicleState& from, const VehicleState& free,
                          double step_s) {
  Motion cg = motion_of_cg(model, free);
  cg.position = motion_of_cg(model, from).position;
  return moved(model, from, cg, step_s);
}

// Impulse J = h f and its moment p x J about the world's origin.
Impulse impulse_of(const Vec3& force_n, const Vec3& point_ned_m, double step_s) {
  return {step_s * force_n, step_s * point_ned_m.cross(force_n)};
}

// Inverse effective mass at the point r from CO, with a = (n, r x n) the unit impulse along n in the body
// frame:
//
//   1 / m_eff = a^T M^-1 a
double inverse_mass_at(const Model& model, const VehicleState& pose, const Vec3& point_ned_m,
                       const Vec3& direction) {
  const Vec3 arm = point_ned_m - pose.position_ned_m;
  const Vec6 along = in_body_frame(pose.orientation, {direction, arm.cross(direction)});
  return along.dot(model.inverse_mass() * along);
}

// The pose is reached with the velocity nu_free + M^-1 J. The velocity there follows from the momentum M
// nu_free + J, with the moment taken about the new position.
VehicleState struck(const Model& model, const VehicleState& from, const VehicleState& free,
                    const Impulse& impulse, const Vec3& current_ned, double step_s) {
  const Impulse push = about(impulse, free.position_ned_m);
  VehicleState estimate = free;
  estimate.velocity_body += model.inverse_mass() * in_body_frame(free.orientation, push);
  Motion cg = motion_of_cg(model, estimate);
  cg.position = motion_of_cg(model, from).position;
  VehicleState next = moved(model, from, cg, step_s);
  next.actuators = free.actuators;
  Impulse momentum = momentum_about_origin_of_body(model, free, current_ned);
  momentum.linear += push.linear;
  momentum.moment += push.moment;
  momentum = about(momentum, next.position_ned_m - free.position_ned_m);
  next.velocity_body = model.inverse_mass() * in_body_frame(next.orientation, momentum);
  next.velocity_body.head<3>() += next.orientation.conjugate() * current_ned;
  return next;
}

}  // namespace halocline::vehicle_sim
