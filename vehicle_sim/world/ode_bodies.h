// SPDX-License-Identifier: BSD-3-Clause
// Bodies and contacts of the Open Dynamics Engine (ODE), for vehicle_world.cc alone.
#pragma once

#include "core/frames.h"
#include "vehicle_sim/dynamics/body_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/world/ode_handles.h"

namespace halocline::vehicle_sim {

// Contacts with a gap up to this, m, are included, since other contacts may push the hull towards them.
inline constexpr double kContactMargin = 0.05;
// Limit of the speed at which a hull is pushed out of the seabed or another hull, m/s.
inline constexpr double kFastestPushOut = 0.2;

inline Vec3 vector_from(const dReal* v) { return {v[0], v[1], v[2]}; }

dBodyID make_body(dWorldID world, const Model& model, const VehicleState& state);
void write_body(dBodyID body, const Model& model, const VehicleState& state);

// Sets the body's mass to `scale` times its mass in ODE: dry mass and inertia with the added mass of heave
// and rotation.
void scale_mass(dBodyID body, const ModelParameters& parameters, double scale);

// Applies the force and torque that take the body, with `scale` times its mass in ODE, from the velocity of
// `now` to that of `next` in a step. The inertia is rotated by `orientation`.
//
//   F = M_ode (v - v_0) / h,  T = I_ode (omega - omega_0) / h
void push_to_velocity(dBodyID body, const Model& model, const VehicleState& now, const VehicleState& next,
                      const Quaternion& orientation, double scale, double step_s);

// Returns the scale at which ODE's body responds to an impulse at `point_ned_m` along `normal_ned` (unit) as
// the vehicle at `pose` does with its added mass: the ratio of the two inverse effective masses there.
double scale_of_mass_at(const Model& model, const VehicleState& pose, const Vec3& point_ned_m,
                        const Vec3& normal_ned);

// Returns a contact at which the first body's point may approach against `normal` at `closing_speed` at most;
// when it is negative, the point must move away.
dContact ode_contact(const Vec3& normal, const Vec3& point, double closing_speed, double friction);

}  // namespace halocline::vehicle_sim
