// SPDX-License-Identifier: BSD-3-Clause
// A vehicle as a rigid body that is pushed: its motion at the centre of gravity, and how an impulse changes
// it.
//
// Model: an impulse J at a point p changes the momentum of vehicle and water, M nu in the body frame (Fossen
// 2021, eq. 6.42 and 6.48; Lamb 1932, art. 119), by J and p x J. Added mass makes a hull heavier across than
// along it, so the momentum is turned with the body: what is conserved is its value in the world frame. Left
// out: the water that two hulls share when they are close (each has its added mass as if alone). Pure
// functions; any number of threads.
#pragma once

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

// The motion of the centre of gravity, world frame.
struct Motion {
  Vec3 position, velocity, angular_velocity;
};

// Of the point of the body that is at `point_ned_m`.
Vec3 velocity_at(const Motion& cg, const Vec3& point_ned_m);

Motion motion_of_cg(const Model& model, const VehicleState& state);

// Writes a motion of the centre of gravity into the state, whose orientation is already set.
void set_motion_of_cg(VehicleState& state, const Model& model, const Motion& cg);

// The state after a step of `step_s` at the velocities of `cg`, from its position and the state's
// orientation.
VehicleState moved(const Model& model, const VehicleState& from, const Motion& cg, double step_s);

// The same at the velocity of `free`, the solution of the step without contacts.
VehicleState moved_freely(const Model& model, const VehicleState& from, const VehicleState& free,
                          double step_s);

// An impulse on a body, world frame, N s; `moment` (N m s) is about the world's origin.
struct Impulse {
  Vec3 linear = Vec3::Zero(), moment = Vec3::Zero();
};

// What `force_n` at `point` gives in `step_s`.
Impulse impulse_of(const Vec3& force_n, const Vec3& point_ned_m, double step_s);

// Momentum of vehicle and water relative to water that moves at `current_ned_mps`; moment about the world's
// origin.
Impulse momentum_of(const Model& model, const VehicleState& state, const Vec3& current_ned_mps);

// How fast the hull's point moves along the unit `direction` for each unit of impulse along it there, 1/kg.
double inverse_mass_at(const Model& model, const VehicleState& pose, const Vec3& point_ned_m,
                       const Vec3& direction);

// Where the vehicle, at `from`, is after a step whose free solution is `free` when `impulse` acts as well:
// its momentum is that of `free` plus the impulse, to rounding; its pose the old one and the first estimate
// of the velocity, x + h v.
VehicleState struck(const Model& model, const VehicleState& from, const VehicleState& free,
                    const Impulse& impulse, const Vec3& current_ned_mps, double step_s);

}  // namespace halocline::vehicle_sim
