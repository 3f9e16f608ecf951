// SPDX-License-Identifier: BSD-3-Clause
// The right-hand side of a vehicle's motion, and its solution step by step.
//
// Model and sources: vehicle_model.h, hull_forces.h, actuator_forces.h, submergence.h. The current changes
// evenly over a step; its rate in the turning body frame is R' dv_c/dt - omega x v_c, which carries a
// neutrally buoyant hull along as the water's own pressure does. Forces of the water scale with the share of
// the hull under it. Integration: the classical Runge-Kutta method of order 4 with the command held over the
// step and the quaternion brought back to unit length after it. For `remus100-pvs` a step of 10 ms errs by
// less than 1e-6 m over minutes where the forces are smooth. Steps up to 20 ms are stable for vehicles of
// this size. Pure functions; may run in any number of threads at once.
//
//   const Model model(remus100_pvs_parameters(CurrentTreatment::kUpstream));
//   VehicleState state;
//   for (int i = 0; i < 1000; ++i) state = rk4_step(model, state, {.propeller_hz = 20}, Water{}, 0.01);
#pragma once

#include "core/frames.h"
#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

// Time derivative of a VehicleState.
struct StateRate {
  Vec3 position = Vec3::Zero();                           // m/s, world
  Eigen::Vector4d orientation = Eigen::Vector4d::Zero();  // of the quaternion's x, y, z, w, 1/s
  Vec6 velocity = Vec6::Zero();                           // m/s^2, rad/s^2, body
  ActuatorValues actuators;                               // rad/s, Hz/s
};

// The flow at a vehicle.
struct RelativeFlow {
  BodyVelocity nu_r;     // velocity relative to the water
  Axes current_rate;     // rate of the current as seen in the body frame, m/s^2
  double speed_mps = 0;  // |v_r|
};

RelativeFlow relative_flow(const Model& model, const VehicleState& state, const Water& water);

// nu_dot: acceleration in the body frame, m/s^2 and rad/s^2, from the state's actuators (not from a command).
Vec6 acceleration(const Model& model, const VehicleState& state, const Water& water);

// All rates. `limited_command`: within the actuators' limits, see limited().
StateRate rate_of_change(const Model& model, const VehicleState& state, const ActuatorValues& limited_command,
                         const Water& water);

// The state after `step_s` (above 0) with the command held. A state or command that is not finite gives one
// that is not finite.
VehicleState rk4_step(const Model& model, const VehicleState& state, const ActuatorValues& command,
                      const Water& water, double step_s);

// Mechanical power of propeller and thrusters, W, from the state's actuators.
double shaft_power_w(const Model& model, const VehicleState& state, const Water& water);

// Kinetic energy 1/2 nu' M nu plus potential energy of weight and buoyancy, joules; zero at rest at z = 0,
// level, with CO, CG and CB at one depth. For a vehicle under water. Without actuators and current it never
// grows.
double mechanical_energy_j(const Model& model, const VehicleState& state);

}  // namespace halocline::vehicle_sim
