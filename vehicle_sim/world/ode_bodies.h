// The ODE side of a VehicleWorld, for vehicle_world.cc and vehicle_links.cc alone: bodies, contacts, what they felt.
#pragma once

#include <optional>

#include "vehicle_sim/dynamics/body_motion.h"
#include "vehicle_sim/world/ode_handles.h"
#include "vehicle_sim/world/vehicle_world.h"

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

// How fast ODE's body moves along the unit `direction` for each unit of impulse along it, as inverse_mass_at;
// `arm_m` from the centre of gravity, both in the body frame; for a scale of 1.
double ode_inverse_mass_at(const ModelParameters& parameters, const Vec3& arm_m, const Vec3& direction);

// A contact that lets the first body's point approach against `normal` by `closing_speed` at most (negative: it must
// part).
dContact ode_contact(const Vec3& normal, const Vec3& point, double closing_speed, double friction);

// A contact with the ground.
struct VehicleWorld::Contact {
  std::size_t vehicle;
  dJointID joint;
  dJointFeedback feedback = {};
};

// A push along a line between two vehicles, or a vehicle and a fixed point, that keeps a gap open.
struct VehicleWorld::Link {
  std::size_t vehicle;               // is pushed along `normal`
  std::optional<std::size_t> other;  // is pushed against it
  Vec3 point, normal;                // where the free velocities lead
  double gap_m;
  double time_left_s;  // in the step after the instant at which the gap was measured
  std::optional<std::size_t> tether;
  dJointID joint = nullptr;
  dJointFeedback feedback = {};
};

}  // namespace halocline::vehicle_sim
