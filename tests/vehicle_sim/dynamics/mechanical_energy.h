// SPDX-License-Identifier: BSD-3-Clause
// Mechanical energy of a vehicle, which never grows without actuators and current.
#pragma once

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

// Returns kinetic energy plus potential energy of weight and buoyancy, J, of a submerged vehicle, with z_g
// and z_b the z of the centres of gravity and of buoyancy:
//
//   E = 1/2 nu^T M nu - W z_g + B z_b
inline double mechanical_energy_j(const Model& model, const VehicleState& state) {
  const ModelParameters& p = model.parameters();
  const double kinetic = 0.5 * state.velocity_body.dot(model.mass() * state.velocity_body);
  const auto depth_of = [&](const Vec3& point) {
    return (state.position_ned_m + state.orientation * point).z();
  };
  return kinetic - model.weight_n() * depth_of(p.center_of_gravity_m) +
         p.buoyancy_n * depth_of(p.center_of_buoyancy_m);
}

}  // namespace halocline::vehicle_sim
