// SPDX-License-Identifier: BSD-3-Clause
// Motion of a vehicle as a rigid body under impulses: the motion of its centre of gravity, and its change by
// an impulse.
//
// Model: an impulse J at a point p changes the momentum of vehicle and water, M nu in the body frame (Fossen
// 2021, eq. 6.42 and 6.48; Lamb 1932, art. 119), by J, and the moment of momentum by p x J. Since the added
// mass of a hull is greater across than along it, the momentum in the body frame changes as the body rotates;
// its value in the world frame is conserved. Left out: the interaction of two hulls through the water when
// they are close (each has its added mass as if alone). Pure functions, safe in any number of threads.
#pragma once

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

// Motion of the centre of gravity in the world frame.
struct Motion {
  Vec3 position, velocity, angular_velocity;
};

Vec3 velocity_at(const Motion& cg, const Vec3& point_ned_m);

Motion motion_of_cg(const Model& model, const VehicleState& state);

// Writes a motion of the centre of gravity into the state, whose orientation must already be set.
void set_motion_of_cg(VehicleState& state, const Model& model, const Motion& cg);

// Returns the state after a step of `step_s` at the velocities of `cg`, from the position in `cg` and the
// orientation in `from`.
VehicleState moved(const Model& model, const VehicleState& from, const Motion& cg, double step_s);

// Returns the state after a step from `from` at the velocity of `free`, the solution of the step without
// contacts.
VehicleState moved_freely(const Model& model, const VehicleState& from, const VehicleState& free,
                          double step_s);

// Impulse on a body in the world frame, N s, with its moment about the world's origin, N m s.
struct Impulse {
  Vec3 linear = Vec3::Zero(), moment = Vec3::Zero();
};

Impulse impulse_of(const Vec3& force_n, const Vec3& point_ned_m, double step_s);

// Returns the change of the point's velocity along the unit vector `direction` for a unit impulse along it
// there, 1/kg.
double inverse_mass_at(const Model& model, const VehicleState& pose, const Vec3& point_ned_m,
                       const Vec3& direction);

// Returns the state after a step from `from` whose free solution is `free`, when `impulse` acts as well. Its
// momentum is that of `free` plus the impulse, to rounding. Its pose is the old one plus h v, with v the
// first estimate of the velocity.
VehicleState struck(const Model& model, const VehicleState& from, const VehicleState& free,
                    const Impulse& impulse, const Vec3& current_ned_mps, double step_s);

}  // namespace halocline::vehicle_sim
