// SPDX-License-Identifier: BSD-3-Clause
// Equations of motion of a vehicle, and their integration step by step.
//
// Model and sources: vehicle_model.h, hull_forces.h, actuator_forces.h, submergence.h. The current changes at
// a constant rate over a step. Its rate of change in the rotating body frame is
//
//   R^T dv_c/dt - omega x v_c
//
// which accelerates a neutrally buoyant hull as the pressure gradient in the water does. Hydrodynamic forces
// are scaled by the submerged share of the hull. Integration: the classical Runge-Kutta method of order 4,
// with the command held over the step and the quaternion normalised after it. For `remus100-pvs` the error of
// 10 ms steps is below 1e-6 m over minutes where the forces are smooth. Steps up to 20 ms are stable for
// vehicles of this size. Pure functions, safe in any number of threads.
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
  Vec3 position = Vec3::Zero();                           // m/s, world frame
  Eigen::Vector4d orientation = Eigen::Vector4d::Zero();  // 1/s, coefficients x, y, z, w
  Vec6 velocity = Vec6::Zero();                           // m/s^2 and rad/s^2, body frame
  ActuatorValues actuators;                               // rad/s, Hz/s
};

struct RelativeFlow {
  BodyVelocity nu_r;     // velocity relative to the water
  Axes current_rate;     // rate of change of the current in the body frame, m/s^2
  double speed_mps = 0;  // |v_r|
};

RelativeFlow relative_flow(const Model& model, const VehicleState& state, const Water& water);

// Returns nu_dot, the acceleration in the body frame, m/s^2 and rad/s^2. Actuators act as they are in the
// state, not as commanded.
Vec6 acceleration(const Model& model, const VehicleState& state, const Water& water);

// Returns all rates of change. `limited_command`: a command within the actuators' limits, see limited().
StateRate rate_of_change(const Model& model, const VehicleState& state, const ActuatorValues& limited_command,
                         const Water& water);

// Returns the state after `step_s` (above 0) with the command held. The result is not finite when the state
// or the command is not.
VehicleState rk4_step(const Model& model, const VehicleState& state, const ActuatorValues& command,
                      const Water& water, double step_s);

// Returns the mechanical power of propeller and thrusters at their speeds in the state, W.
double shaft_power_w(const Model& model, const VehicleState& state, const Water& water);

}  // namespace halocline::vehicle_sim
