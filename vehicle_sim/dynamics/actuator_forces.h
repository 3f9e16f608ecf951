// SPDX-License-Identifier: BSD-3-Clause
// Forces of fins, propeller and thrusters, and how actuators follow their commands.
//
// Body frame about CO; N and N m; signs of VehicleState's ActuatorValues. Sources: Allen, Vorus and Prestero
// 2000 and Fossen 2021, section 9.4 (published laws); Polhamus 1966, NASA TN D-3767 (FinLaw::kLocalFlow: the
// force of a thin low fin stands across its chord). Left out: the propeller's race over the fins,
// interference of fin and hull.
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

// Forces in the plane of a fin's motion: along the body's axis and across it.
struct FinForce {
  double along = 0, across = 0;
};

// `across_co`: velocity across the axis at CO, `across_fin`: at the fin; for the laws see rudder_force.
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

// `nu_r`: velocity relative to the water, m/s and rad/s. `deflection_rad` positive to starboard turn.
// kDeflection: Y = -1/2 rho (u^2 + v^2) A C_L delta, X = -1/2 rho (u^2 + v^2) A C_L delta^2, N = x Y.
// kLocalFlow: with v_f = v + x r, along the chord u_c = u cos(delta) - v_f sin(delta), across it
// v_n = u sin(delta) + v_f cos(delta): F_n = -1/2 rho A (C_L |u_c| + C_Dn |v_n|) v_n along the fin's normal
// (sin delta, cos delta). Continuous at every angle, and takes energy from the vehicle at every one.
inline BodyForce rudder_force(const FinPair& fins, double density, const BodyVelocity& nu_r,
                              double deflection_rad) {
  const FinForce f = fin_force(fins, density, nu_r.u, nu_r.v, nu_r.v + fins.x_m * nu_r.r, deflection_rad);
  return {f.along, f.across, 0, 0, 0, fins.x_m * f.across};
}

// The same turned into the vertical plane, w - x q for v + x r: Z and M = -x Z; positive deflection pitches
// the bow down.
inline BodyForce stern_planes_force(const FinPair& fins, double density, const BodyVelocity& nu_r,
                                    double deflection_rad) {
  const FinForce f = fin_force(fins, density, nu_r.u, nu_r.w, nu_r.w - fins.x_m * nu_r.q, deflection_rad);
  return {f.along, 0, f.across, 0, -fins.x_m * f.across, 0};
}

// K_T n^2 and K_Q n^2, with the sign of the turn rate n: thrust is rho D^4, the shaft's torque rho D^5 times
// as much.
struct ThrusterLoad {
  double thrust = 0, torque = 0;
};

// `nu_r` as above; `speed_mps` for ThrusterInflow::kSpeed, 0 or above, over ground or relative by the model's
// CurrentTreatment. `turn_rate_hz` of any sign.
inline ThrusterLoad thruster_load(const Thruster& t, const BodyVelocity& nu_r, double speed_mps,
                                  double turn_rate_hz) {
  const double n = turn_rate_hz, d = t.diameter_m;
  double thrust = t.thrust_at_rest * std::abs(n) * n, torque = t.torque_at_rest * std::abs(n) * n;
  if (n < 0) thrust *= t.astern_ratio;
  const bool is_axial = t.inflow == ThrusterInflow::kAxial;
  if (is_axial || n > 0) {
    // K(J) n^2 = K0 n^2 + (Kmax - K0) / Jmax * (V_a / D) |n|
    const double along_shaft =
        is_axial ? dot(Axes(t.direction), nu_r.linear() + cross(nu_r.angular(), Axes(t.position_m)))
                 : speed_mps;
    const double inflow = d > 0 ? t.advance_speed_ratio * along_shaft / d * std::abs(n) / t.advance_max : 0;
    thrust += (t.thrust_at_max - t.thrust_at_rest) * inflow;
    torque += (t.torque_at_max - t.torque_at_rest) * inflow;
  }
  return {thrust, torque};
}

// The thrust on the hull and the part of the shaft's torque that turns it, with the shares of Thruster
// applied.
inline BodyForce thruster_force(const Thruster& t, double density, const BodyVelocity& nu_r, double speed_mps,
                                double turn_rate_hz) {
  const Axes direction = t.direction, position = t.position_m;
  const ThrusterLoad load = thruster_load(t, nu_r, speed_mps, turn_rate_hz);
  const double d = t.diameter_m, d4 = d * d * d * d;
  const Axes push = t.thrust_share * density * d4 * load.thrust * direction;
  return {push, cross(position, push) + t.torque_share * density * d4 * d * load.torque * direction};
}

// Power that the shaft takes, W: 2 pi n Q; 0 where the water drives it.
inline double shaft_power_w(const Thruster& t, double density, const BodyVelocity& nu_r, double speed_mps,
                            double turn_rate_hz) {
  const double d = t.diameter_m, d5 = d * d * d * d * d;
  const double torque_nm = density * d5 * thruster_load(t, nu_r, speed_mps, turn_rate_hz).torque;
  return std::max(2 * std::numbers::pi * turn_rate_hz * torque_nm, 0.0);
}

// The command held to the limits of the actuators. `command` finite.
ActuatorValues limited(const ModelParameters& model, const ActuatorValues& command);

// What a vehicle does without a pilot: propeller and thrusters stopped, fins amidships, a buoyancy engine at
// its greatest volume and a moving mass aft, so that it climbs.
ActuatorValues safe_state(const ModelParameters& model);

// Rate of change of each actuator, per second: (limited command - value) / lag, of slow ones no faster than
// their rate.
ActuatorValues actuator_rate(const ModelParameters& model, const ActuatorValues& value,
                             const ActuatorValues& limited_command);

}  // namespace halocline::vehicle_sim
