// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/actuator_forces.h"

namespace halocline::vehicle_sim {
namespace {

double held(double value, double limit) { return std::clamp(value, -limit, limit); }

// Returns the rate of an actuator with first-order lag and rate limit:
//
//   d x / dt = clip((x_c - x) / T, +-rate)
double slow_rate(const SlowActuator& a, double value, double command) {
  return held((command - value) / a.lag_s, a.rate);
}

}  // namespace

// Saturation: -limit <= command <= limit. The weight of a model without one cannot be released.
ActuatorValues limited(const ModelParameters& p, const ActuatorValues& command) {
  ActuatorValues held_to;
  held_to.rudder_rad = held(command.rudder_rad, p.fin_servo.max_angle_rad);
  held_to.stern_planes_rad = held(command.stern_planes_rad, p.fin_servo.max_angle_rad);
  held_to.propeller_hz = held(command.propeller_hz, p.propeller.max_hz);
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    held_to.thruster_hz[i] = held(command.thruster_hz[i], p.thrusters[i].max_hz);
  }
  held_to.buoyancy_m3 = held(command.buoyancy_m3, p.buoyancy_engine.pump.limit);
  held_to.moving_mass_m = held(command.moving_mass_m, p.moving_mass.drive.limit);
  if (p.drop_weight.mass_kg > 0) held_to.weight = command.weight;
  return held_to;
}

// First-order lag of each actuator (Fossen 2021, section 9.4):
//
//   d delta / dt = (delta_c - delta) / T
ActuatorValues actuator_rate(const ModelParameters& p, const ActuatorValues& value,
                             const ActuatorValues& command) {
  ActuatorValues rate;
  rate.rudder_rad = (command.rudder_rad - value.rudder_rad) / p.fin_servo.lag_s;
  rate.stern_planes_rad = (command.stern_planes_rad - value.stern_planes_rad) / p.fin_servo.lag_s;
  rate.propeller_hz = (command.propeller_hz - value.propeller_hz) / p.propeller.lag_s;
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    rate.thruster_hz[i] = (command.thruster_hz[i] - value.thruster_hz[i]) / p.thrusters[i].lag_s;
  }
  rate.buoyancy_m3 = slow_rate(p.buoyancy_engine.pump, value.buoyancy_m3, command.buoyancy_m3);
  rate.moving_mass_m = slow_rate(p.moving_mass.drive, value.moving_mass_m, command.moving_mass_m);
  return rate;
}

ActuatorValues safe_state(const ModelParameters& p) {
  return {.buoyancy_m3 = p.buoyancy_engine.pump.limit, .moving_mass_m = -p.moving_mass.drive.limit};
}

}  // namespace halocline::vehicle_sim
