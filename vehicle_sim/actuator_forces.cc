#include "vehicle_sim/actuator_forces.h"

#include <algorithm>
#include <cmath>

namespace halocline::vehicle_sim {
namespace {

// Forces in the plane of a fin's motion: along the body's axis and across it.
struct FinForce {
  double along = 0, across = 0;
};

// `across_co`: velocity across the axis at CO, `across_fin`: at the fin.
FinForce fin_force(const FinPair& fins, double density, double u, double across_co, double across_fin,
                   double deflection) {
  const double half_rho_area = -0.5 * density * fins.area_m2;
  if (fins.law == FinLaw::kDeflection) {
    const double speed_squared = u * u + across_co * across_co;
    const double slope = half_rho_area * speed_squared * fins.lift_slope_per_rad;
    return {slope * deflection * deflection, slope * deflection};
  }
  const double s = std::sin(deflection), c = std::cos(deflection);
  const double chordwise = u * c - across_fin * s, normal = u * s + across_fin * c;
  const double force = half_rho_area * normal *
                       (fins.lift_slope_per_rad * std::abs(chordwise) + fins.normal_drag * std::abs(normal));
  return {force * s, force * c};
}

double held(double value, double limit) { return std::clamp(value, -limit, limit); }

}  // namespace

Vec6 rudder_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad) {
  const double v = nu_r[1];
  const FinForce f = fin_force(fins, density, nu_r[0], v, v + fins.x_m * nu_r[5], deflection_rad);
  Vec6 force;
  force << f.along, f.across, 0, 0, 0, fins.x_m * f.across;
  return force;
}

Vec6 stern_planes_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad) {
  const double w = nu_r[2];
  const FinForce f = fin_force(fins, density, nu_r[0], w, w - fins.x_m * nu_r[4], deflection_rad);
  Vec6 force;
  force << f.along, 0, f.across, 0, -fins.x_m * f.across, 0;
  return force;
}

Vec6 thruster_force(const Thruster& t, double density, const Vec6& nu_r, double speed_mps,
                    double turn_rate_hz) {
  const double n = turn_rate_hz, d = t.diameter_m;
  double thrust = t.thrust_at_rest * std::abs(n) * n, torque = t.torque_at_rest * std::abs(n) * n;
  if (n < 0) thrust *= t.astern_ratio;
  const bool is_axial = t.inflow == ThrusterInflow::kAxial;
  if (is_axial || n > 0) {
    // K(J) n^2 = K0 n^2 + (Kmax - K0) / Jmax * (V_a / D) |n|
    const double along_shaft =
        is_axial ? t.direction.dot(nu_r.head<3>() + nu_r.tail<3>().cross(t.position_m)) : speed_mps;
    const double inflow = d > 0 ? t.advance_speed_ratio * along_shaft / d * std::abs(n) / t.advance_max : 0;
    thrust += (t.thrust_at_max - t.thrust_at_rest) * inflow;
    torque += (t.torque_at_max - t.torque_at_rest) * inflow;
  }
  const double d4 = d * d * d * d;
  const Vec3 push = t.thrust_share * density * d4 * thrust * t.direction;
  Vec6 force;
  force << push, t.position_m.cross(push) + t.torque_share * density * d4 * d * torque * t.direction;
  return force;
}

ActuatorValues limited(const ModelParameters& p, const ActuatorValues& command) {
  ActuatorValues held_to;
  held_to.rudder_rad = held(command.rudder_rad, p.fin_servo.max_angle_rad);
  held_to.stern_planes_rad = held(command.stern_planes_rad, p.fin_servo.max_angle_rad);
  held_to.propeller_hz = held(command.propeller_hz, p.propeller.max_hz);
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    held_to.thruster_hz[i] = held(command.thruster_hz[i], p.thrusters[i].max_hz);
  }
  return held_to;
}

ActuatorValues actuator_rate(const ModelParameters& p, const ActuatorValues& value,
                             const ActuatorValues& command) {
  ActuatorValues rate;
  rate.rudder_rad = (command.rudder_rad - value.rudder_rad) / p.fin_servo.lag_s;
  rate.stern_planes_rad = (command.stern_planes_rad - value.stern_planes_rad) / p.fin_servo.lag_s;
  rate.propeller_hz = (command.propeller_hz - value.propeller_hz) / p.propeller.lag_s;
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    rate.thruster_hz[i] = (command.thruster_hz[i] - value.thruster_hz[i]) / p.thrusters[i].lag_s;
  }
  return rate;
}

}  // namespace halocline::vehicle_sim
