// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/world/ode_bodies.h"

namespace halocline::vehicle_sim {
namespace {

double ode_kilograms(const ModelParameters& p) { return p.mass_kg + p.added_mass(2, 2); }

Mat3 ode_inertia(const ModelParameters& p) {
  return p.inertia_kg_m2 + Mat3(p.added_mass.diagonal().tail<3>().asDiagonal());
}

// Inverse effective mass of the body: the change of velocity along the unit vector n by a unit impulse along
// it at r from the centre of gravity, body frame.
//
//   1 / m_eff = 1 / m + (r x n) . I^-1 (r x n)
double ode_inverse_mass_at(const ModelParameters& p, const Vec3& arm_m, const Vec3& direction) {
  const Vec3 moment = arm_m.cross(direction);
  return 1 / ode_kilograms(p) + moment.dot(ode_inertia(p).inverse() * moment);
}

}  // namespace

void scale_mass(dBodyID body, const ModelParameters& p, double scale) {
  dMass mass;
  const Mat3 inertia = scale * ode_inertia(p);
  dMassSetParameters(&mass, scale * ode_kilograms(p), 0, 0, 0, inertia(0, 0), inertia(1, 1), inertia(2, 2),
                     inertia(0, 1), inertia(0, 2), inertia(1, 2));
  dBodySetMass(body, &mass);
}

void write_body(dBodyID body, const Model& model, const VehicleState& state) {
  const Motion cg = motion_of_cg(model, state);
  const Quaternion& q = state.orientation;
  const dQuaternion orientation = {q.w(), q.x(), q.y(), q.z()};
  dBodySetPosition(body, cg.position.x(), cg.position.y(), cg.position.z());
  dBodySetQuaternion(body, orientation);
  dBodySetLinearVel(body, cg.velocity.x(), cg.velocity.y(), cg.velocity.z());
  dBodySetAngularVel(body, cg.angular_velocity.x(), cg.angular_velocity.y(), cg.angular_velocity.z());
}

dBodyID make_body(dWorldID world, const Model& model, const VehicleState& state) {
  const dBodyID body = dBodyCreate(world);
  scale_mass(body, model.parameters(), 1);
  dBodySetGyroscopicMode(body, 0);
  dBodySetFiniteRotationMode(body, 1);
  dBodySetAutoDisableFlag(body, 0);
  write_body(body, model, state);
  return body;
}

// F = M_ode (v - v_0) / h and T = I_ode (omega - omega_0) / h, in the world frame.
void push_to_velocity(dBodyID body, const Model& model, const VehicleState& now, const VehicleState& next,
                      const Quaternion& orientation, double scale, double step_s) {
  const ModelParameters& p = model.parameters();
  const Motion before = motion_of_cg(model, now), after = motion_of_cg(model, next);
  const Vec3 force = scale * ode_kilograms(p) / step_s * (after.velocity - before.velocity);
  const Vec3 spin_up = (after.angular_velocity - before.angular_velocity) / step_s;
  const Vec3 torque = scale * (orientation * (ode_inertia(p) * (orientation.conjugate() * spin_up)));
  dBodySetForce(body, force.x(), force.y(), force.z());
  dBodySetTorque(body, torque.x(), torque.y(), torque.z());
}

double scale_of_mass_at(const Model& model, const VehicleState& pose, const Vec3& point_ned_m,
                        const Vec3& normal_ned) {
  const Quaternion to_body = pose.orientation.conjugate();
  const Vec3 arm = to_body * (point_ned_m - motion_of_cg(model, pose).position);
  return ode_inverse_mass_at(model.parameters(), arm, to_body * normal_ned) /
         inverse_mass_at(model, pose, point_ned_m, normal_ned);
}

dContact ode_contact(const Vec3& normal, const Vec3& point, double closing_speed, double friction) {
  dContact contact = {};
  contact.surface.mode = dContactApprox1 | dContactMotionN;
  contact.surface.mu = friction;
  contact.surface.motionN = -closing_speed;
  for (int k = 0; k < 3; ++k) {
    contact.geom.pos[k] = point[k];
    contact.geom.normal[k] = normal[k];
  }
  return contact;
}

}  // namespace halocline::vehicle_sim
