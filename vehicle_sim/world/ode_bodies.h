// SPDX-License-Identifier: BSD-3-Clause
// The ODE side of a VehicleWorld, for vehicle_world.cc alone: bodies and contacts.
#pragma once

#include "core/frames.h"
#include "vehicle_sim/dynamics/body_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/world/ode_handles.h"

namespace halocline::vehicle_sim {

// Contacts this far off are watched, should others push towards them, metres.
inline constexpr double kContactMargin = 0.05;
// A hull found in the ground, or two in each other, are moved apart no faster, m/s.
inline constexpr double kFastestPushOut = 0.2;

inline Vec3 vector_from(const dReal* v) { return {v[0], v[1], v[2]}; }

dBodyID make_body(dWorldID world, const Model& model, const VehicleState& state);
void write_body(dBodyID body, const Model& model, const VehicleState& state);

// Gives the body `scale` times ODE's mass: dry mass and inertia with the added mass of heave and of rotation.
void scale_mass(dBodyID body, const ModelParameters& parameters, double scale);

// Gives the body, which has `scale` times ODE's mass, the force and torque that take it from the velocity of
// `now` to that of `next` in a step: M_ode (v - v_0) / h and I_ode (omega - omega_0) / h, with the inertia
// turned as `orientation`.
void push_to_velocity(dBodyID body, const Model& model, const VehicleState& now, const VehicleState& next,
                      const Quaternion& orientation, double scale, double step_s);

// The scale at which ODE's body gives way at `point_ned_m` along `normal_ned` (unit) as the vehicle at `pose`
// does with its added mass: the ratio of both inverse masses there.
double scale_of_mass_at(const Model& model, const VehicleState& pose, const Vec3& point_ned_m,
                        const Vec3& normal_ned);

// A contact that lets the first body's point approach against `normal` by `closing_speed` at most (negative:
// it must part).
dContact ode_contact(const Vec3& normal, const Vec3& point, double closing_speed, double friction);

}  // namespace halocline::vehicle_sim
