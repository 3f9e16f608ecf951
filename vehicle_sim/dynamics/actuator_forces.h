// SPDX-License-Identifier: BSD-3-Clause
// Forces of fins, propeller and thrusters, and the response of actuators to their commands.
//
// Body frame about CO; N and N m; signs of VehicleState's ActuatorValues. Sources: Allen, Vorus and Prestero
// 2000 and Fossen 2021, section 9.4 (published laws); Polhamus 1966, NASA TN D-3767 (FinLaw::kLocalFlow: the
// force on a thin fin of low aspect ratio is normal to its chord). Left out: the propeller's slipstream over
// the fins, interference of fin and hull.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

// Force of a fin in the plane normal to its shaft, N: along the body's x axis and across it.
struct FinForce {
  double along = 0, across = 0;
};

// Returns the force of a pair of fins, see rudder_force. `across_co`: velocity across the x axis at CO, m/s;
// `across_fin`: the same at the fin.
inline FinForce fin_force(const FinPair& fins, double density, double u, double across_co, double across_fin,
                          double deflection_rad) {
  const double half_rho_area = -0.5 * density * fins.area_m2;
  if (fins.law == FinLaw::kDeflection) {
    const double speed_squared = u * u + across_co * across_co;
    const double slope = half_rho_area * speed_squared * fins.lift_slope_per_rad;
    return {slope * deflection_rad * deflection_rad, slope * deflection_rad};
  }
  const double s = elementary::sin(deflection_rad), c = elementary::cos(deflection_rad);
  const double chordwise = u * c - across_fin * s, normal = u * s + across_fin * c;
  const double force = half_rho_area * normal *
                       (fins.lift_slope_per_rad * std::abs(chordwise) + fins.normal_drag * std::abs(normal));
  return {force * s, force * c};
}

// Returns force and moment of the rudder. `nu_r`: velocity relative to the water, m/s and rad/s;
// `deflection_rad`: positive turns to starboard.
//
// FinLaw::kDeflection:
//
//   Y = -1/2 rho (u^2 + v^2) A C_L delta
//   X = -1/2 rho (u^2 + v^2) A C_L delta^2
//
// FinLaw::kLocalFlow, with the velocity across the axis at the fin, v_f, and the velocities along and across
// its chord, u_c and v_n:
//
//   v_f = v + x r
//   u_c = u cos(delta) - v_f sin(delta)
//   v_n = u sin(delta) + v_f cos(delta)
//   F_n = -1/2 rho A (C_L |u_c| + C_Dn |v_n|) v_n
//   X = F_n sin(delta),  Y = F_n cos(delta)
//
// This law is continuous at every angle, and it dissipates energy at every angle. For both laws N = x Y.
inline BodyForce rudder_force(const FinPair& fins, double density, const BodyVelocity& nu_r,
                              double deflection_rad) {
  const FinForce f = fin_force(fins, density, nu_r.u, nu_r.v, nu_r.v + fins.x_m * nu_r.r, deflection_rad);
  return {f.along, f.across, 0, 0, 0, fins.x_m * f.across};
}

// Returns force and moment of the stern planes: the laws of rudder_force in the vertical plane, with w - x q
// for v + x r, Z for Y and M = -x Z. A positive deflection pitches the bow down.
inline BodyForce stern_planes_force(const FinPair& fins, double density, const BodyVelocity& nu_r,
                                    double deflection_rad) {
  const FinForce f = fin_force(fins, density, nu_r.u, nu_r.w, nu_r.w - fins.x_m * nu_r.q, deflection_rad);
  return {f.along, 0, f.across, 0, -fins.x_m * f.across, 0};
}

// Load of a thruster in Hz^2: K_T n^2 and K_Q n^2, with the sign of the speed n. The thrust is rho D^4 times
// `thrust`, the shaft torque rho D^5 times `torque`.
struct ThrusterLoad {
  double thrust = 0, torque = 0;
};

// Returns the load of a thruster. `speed_mps`: inflow speed for ThrusterInflow::kSpeed, 0 or above, over
// ground or relative to the water by the model's CurrentTreatment. `turn_rate_hz`: thruster speed n of either
// sign.
inline ThrusterLoad thruster_load(const Thruster& t, const BodyVelocity& nu_r, double speed_mps,
                                  double turn_rate_hz) {
  const double n = turn_rate_hz, d = t.diameter_m;
  double thrust = t.thrust_at_rest * std::abs(n) * n, torque = t.torque_at_rest * std::abs(n) * n;
  if (n < 0) thrust *= t.astern_ratio;
  const bool is_axial = t.inflow == ThrusterInflow::kAxial;
  if (is_axial || n > 0) {
    // K_T and K_Q are linear in the advance number J = V_a / (|n| D), K(J) = K0 + (Kmax - K0) J / Jmax,
    // so that
    //
    //   K(J) n^2 = K0 n^2 + (Kmax - K0) / Jmax (V_a / D) |n|
    const double along_shaft =
        is_axial ? dot(Axes(t.direction), nu_r.linear() + cross(nu_r.angular(), Axes(t.position_m)))
                 : speed_mps;
    const double inflow = d > 0 ? t.advance_speed_ratio * along_shaft / d * std::abs(n) / t.advance_max : 0;
    thrust += (t.thrust_at_max - t.thrust_at_rest) * inflow;
    torque += (t.torque_at_max - t.torque_at_rest) * inflow;
  }
  return {thrust, torque};
}

// Returns force and moment of a thruster on the hull: the thrust, and the part of the shaft torque that
// reaches the hull, each with its share in Thruster.
inline BodyForce thruster_force(const Thruster& t, double density, const BodyVelocity& nu_r, double speed_mps,
                                double turn_rate_hz) {
  const Axes direction = t.direction, position = t.position_m;
  const ThrusterLoad load = thruster_load(t, nu_r, speed_mps, turn_rate_hz);
  const double d = t.diameter_m, d4 = d * d * d * d;
  const Axes push = t.thrust_share * density * d4 * load.thrust * direction;
  return {push, cross(position, push) + t.torque_share * density * d4 * d * load.torque * direction};
}

// Returns the power that the shaft takes up, 2 pi n Q, W; 0 where the water drives the propeller.
inline double shaft_power_w(const Thruster& t, double density, const BodyVelocity& nu_r, double speed_mps,
                            double turn_rate_hz) {
  const double d = t.diameter_m, d5 = d * d * d * d * d;
  const double torque_nm = density * d5 * thruster_load(t, nu_r, speed_mps, turn_rate_hz).torque;
  return std::max(2 * std::numbers::pi * turn_rate_hz * torque_nm, 0.0);
}

// Returns the command limited to the range of each actuator. `command` must be finite.
ActuatorValues limited(const ModelParameters& model, const ActuatorValues& command);

// Returns the command of a vehicle without a pilot: propeller and thrusters stopped, fins amidships, the
// buoyancy engine at its greatest volume and the moving mass aft, so that the vehicle climbs.
ActuatorValues safe_state(const ModelParameters& model);

// Returns the rate of change of each actuator, per second: (limited command - value) / lag, for a
// SlowActuator limited to its rate.
ActuatorValues actuator_rate(const ModelParameters& model, const ActuatorValues& value,
                             const ActuatorValues& limited_command);

}  // namespace halocline::vehicle_sim
