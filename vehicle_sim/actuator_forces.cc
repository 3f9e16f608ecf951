#include "vehicle_sim/actuator_forces.h"

#include <algorithm>
#include <cmath>

namespace halocline::vehicle_sim {
namespace {

// Force across the fin and drag along it, for the speed squared in its plane.
struct FinForce {
  double across = 0, along = 0;
};

FinForce fin_force(const FinPair& fins, double density, double speed_squared, double deflection) {
  const double slope = -0.5 * density * speed_squared * fins.area_m2 * fins.lift_slope_per_rad;
  return {slope * deflection, slope * deflection * deflection};
}

}  // namespace

Vec6 rudder_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad) {
  const FinForce f = fin_force(fins, density, nu_r[0] * nu_r[0] + nu_r[1] * nu_r[1], deflection_rad);
  Vec6 force;
  force << f.along, f.across, 0, 0, 0, fins.x_m * f.across;
  return force;
}

Vec6 stern_planes_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad) {
  const FinForce f = fin_force(fins, density, nu_r[0] * nu_r[0] + nu_r[2] * nu_r[2], deflection_rad);
  Vec6 force;
  force << f.along, 0, f.across, 0, -fins.x_m * f.across, 0;
  return force;
}

Vec6 propeller_force(const Propeller& p, double density, double speed_mps, double turn_rate_hz) {
  const double n = turn_rate_hz, d = p.diameter_m;
  double thrust = p.thrust_at_rest * std::abs(n) * n, torque = p.torque_at_rest * std::abs(n) * n;
  if (n > 0) {
    // K(J) n^2 = K0 n^2 + (Kmax - K0) / Jmax * (V_a / D) n
    const double inflow = p.advance_speed_ratio * speed_mps / d * n / p.advance_max;
    thrust += (p.thrust_at_max - p.thrust_at_rest) * inflow;
    torque += (p.torque_at_max - p.torque_at_rest) * inflow;
  }
  const double d4 = d * d * d * d;
  Vec6 force = Vec6::Zero();
  force[0] = p.thrust_share * density * d4 * thrust;
  force[3] = p.torque_share * density * d4 * d * torque;
  return force;
}

ActuatorValues limited(const ActuatorDynamics& a, const ActuatorValues& command) {
  return {std::clamp(command.rudder_rad, -a.max_fin_angle_rad, a.max_fin_angle_rad),
          std::clamp(command.stern_planes_rad, -a.max_fin_angle_rad, a.max_fin_angle_rad),
          std::clamp(command.propeller_hz, -a.max_propeller_hz, a.max_propeller_hz)};
}

ActuatorValues actuator_rate(const ActuatorDynamics& a, const ActuatorValues& value,
                             const ActuatorValues& command) {
  return {(command.rudder_rad - value.rudder_rad) / a.fin_lag_s,
          (command.stern_planes_rad - value.stern_planes_rad) / a.fin_lag_s,
          (command.propeller_hz - value.propeller_hz) / a.propeller_lag_s};
}

}  // namespace halocline::vehicle_sim
