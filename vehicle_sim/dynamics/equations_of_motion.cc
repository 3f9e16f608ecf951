// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/equations_of_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/elementary.h"
#include "vehicle_sim/dynamics/actuator_forces.h"
#include "vehicle_sim/dynamics/hull_forces.h"
#include "vehicle_sim/dynamics/submergence.h"

namespace halocline::vehicle_sim {
namespace {

// A VehicleState, or its rate of change, as plain numbers (see body_axes.h for the reason).
struct Numbers {
  Axes position;
  std::array<double, 4> orientation;  // x, y, z, w
  BodyVelocity velocity;
  ActuatorValues actuators;
};

Numbers to_numbers(const VehicleState& s) {
  const Quaternion& q = s.orientation;
  return {s.position_ned_m, {q.x(), q.y(), q.z(), q.w()}, s.velocity_body, s.actuators};
}

// World axes in the body frame: the rows of the rotation matrix from body to world.
struct WorldAxes {
  Axes north, east, down;
};

// The quaternion is normalised here, since between the stages of a step its length differs from 1 by the
// square of the angle of rotation.
WorldAxes world_axes(const std::array<double, 4>& q) {
  const double length = std::sqrt((q[0] * q[0] + q[2] * q[2]) + (q[1] * q[1] + q[3] * q[3]));
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  const double xx = 2 * x * x, xy = 2 * y * x, xz = 2 * z * x, yy = 2 * y * y, yz = 2 * z * y, zz = 2 * z * z;
  const double wx = 2 * x * w, wy = 2 * y * w, wz = 2 * z * w;
  return {{1 - (yy + zz), xy - wz, xz + wy},
          {xy + wz, 1 - (xx + zz), yz - wx},
          {xz - wy, yz + wx, 1 - (xx + yy)}};
}

// Current in the body frame by the yaw angle alone, with V and beta the speed and direction of the current
// and (cos psi, sin psi) the horizontal direction of the body's x axis:
//
//   u_c = V cos(beta - psi),  v_c = V sin(beta - psi),  w_c = 0
Axes turned_by_yaw(const WorldAxes& axes, const Vec3& v) {
  const double north = axes.north.x, east = axes.east.x, level = elementary::hypot(north, east);
  const double cos_yaw = level > 0 ? north / level : 1, sin_yaw = level > 0 ? east / level : 0;
  return {cos_yaw * v.x() + sin_yaw * v.y(), cos_yaw * v.y() - sin_yaw * v.x(), 0};
}

Axes turned_to_body(const WorldAxes& axes, const Vec3& v) {
  return v.x() * axes.north + v.y() * axes.east + v.z() * axes.down;
}

// Velocity relative to the water, and the rate of change of the current in the rotating body frame (Fossen
// 2021, section 10.3):
//
//   nu_r    = nu - (R^T v_c, 0)
//   v_c_dot = R^T dv_c/dt - omega x v_c
RelativeFlow relative_flow(const Model& model, const BodyVelocity& nu, const WorldAxes& axes,
                           const Water& water) {
  RelativeFlow flow;
  flow.nu_r = nu;
  if (!water.current_ned_mps.isZero(0) || !water.current_rate_ned_mps2.isZero(0)) {
    const bool by_yaw = model.parameters().current_treatment == CurrentTreatment::kUpstream;
    const auto to_body = [&](const Vec3& v) {
      return by_yaw ? turned_by_yaw(axes, v) : turned_to_body(axes, v);
    };
    const Axes current = to_body(water.current_ned_mps);
    flow.nu_r = {nu.linear() - current, nu.angular()};
    flow.current_rate = cross(current, by_yaw ? Axes(0, 0, nu.r) : nu.angular());  // -omega x v_c
    if (!water.current_rate_ned_mps2.isZero(0))
      flow.current_rate = flow.current_rate + to_body(water.current_rate_ned_mps2);
  }
  flow.speed_mps = length(flow.nu_r.linear());
  return flow;
}

Vec3 to_vec3(const Axes& a) { return {a.x, a.y, a.z}; }

Submergence submergence(const ModelParameters& p, const Numbers& s, const Water& water) {
  const double surface_z = surface_z_at(water, to_vec3(s.position));
  if (is_wholly_submerged(p.hull, s.position.z - surface_z)) return {};
  VehicleState pose;
  pose.position_ned_m = to_vec3(s.position);
  pose.orientation = Quaternion(s.orientation.data());
  return submergence(p, pose, surface_z, water.surface_slope);
}

WetFloats wet_floats(const ModelParameters& p, const Numbers& s, const WorldAxes& axes, const Water& water) {
  if (p.floats.empty()) return {};
  const double surface_z = surface_z_at(water, to_vec3(s.position));
  return wet_floats(p.floats, surface_z - s.position.z, axes.down, turned_to_body(axes, water.surface_slope));
}

BodyForce thrusters_force(const ModelParameters& p, const Numbers& state, const RelativeFlow& flow) {
  BodyForce force;
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    force = force + thruster_force(p.thrusters[i], p.water_density_kg_m3, flow.nu_r, flow.speed_mps,
                                   state.actuators.thruster_hz[i]);
  }
  return force;
}

// Buoyancy of the floats, and the force of the pressure gradient in water that accelerates at a_w.
// relative_flow already accelerates the whole vehicle with the water, which applies m a_w at the centre of
// gravity r_g. The rest is
//
//   X = rho g V up,         K = c x X                                          buoyancy
//   X = (rho V + m_b - m) a_w,  K = (rho V c + m_b r_b - m r_g) x a_w         pressure gradient
//
// with V and c the volume and centroid of the floats' wet part, and m_b and r_b the mass of the water that
// the body displaces and its centre. In waves much longer than the hull, buoyancy and m a_w together with
// this rest are the Froude-Krylov force.
BodyForce floats_force(const Model& model, const WetFloats& wet, const WorldAxes& axes, const Water& water) {
  const ModelParameters& p = model.parameters();
  const double rho = p.water_density_kg_m3, g = p.gravity_m_s2;
  const Axes up = -1.0 * axes.down;
  const BodyForce buoyancy(rho * g * wet.volume_m3 * up, rho * g * cross(wet.moment_m4, up));
  const Axes rate = turned_to_body(axes, water.current_rate_ned_mps2);
  const double body_kg = wet.bottom_share * p.buoyancy_n / g;  // mass of the water that the body displaces
  const double excess_kg = rho * wet.volume_m3 + body_kg - p.mass_kg;
  const Axes excess_moment =
      rho * wet.moment_m4 + body_kg * Axes(p.center_of_buoyancy_m) - p.mass_kg * Axes(p.center_of_gravity_m);
  return buoyancy + BodyForce(excess_kg * rate, cross(excess_moment, rate));
}

// Returns the inflow speed of the propeller by the model's CurrentTreatment.
double inflow_speed_mps(const ModelParameters& p, const Numbers& state, const RelativeFlow& flow) {
  return p.current_treatment == CurrentTreatment::kUpstream ? length(state.velocity.linear())
                                                            : flow.speed_mps;
}

BodyForce hull_force(const ModelParameters& p, const RelativeFlow& flow) {
  const double rho = p.water_density_kg_m3;
  BodyForce force = damping_force(p.damping, flow.nu_r, flow.speed_mps) +
                    cross_flow_force(p.cross_flow, rho, p.hull.diameter_m, flow.nu_r);
  if (p.lift_drag.reference_area_m2 > 0)
    force = force + lift_drag_force(p.lift_drag, rho, flow.nu_r, flow.speed_mps);
  if (p.body_lift.reference_area_m2 > 0) force = force + body_lift_force(p.body_lift, rho, flow.nu_r);
  return force;
}

BodyForce stern_force(const ModelParameters& p, const Numbers& state, const RelativeFlow& flow) {
  const double rho = p.water_density_kg_m3;
  return rudder_force(p.rudder, rho, flow.nu_r, state.actuators.rudder_rad) +
         stern_planes_force(p.stern_planes, rho, flow.nu_r, state.actuators.stern_planes_rad) +
         thruster_force(p.propeller, rho, flow.nu_r, inflow_speed_mps(p, state, flow),
                        state.actuators.propeller_hz);
}

// Weight at CG and buoyancy at CB (Fossen 2021, section 4.1), with d the world's z axis in the body frame,
// `down`:
//
//   -g(eta) = ((W - B) d, (W r_g - B r_b) x d)
BodyForce restoring_force(const Model& model, const Axes& down, const Submergence& under) {
  const ModelParameters& p = model.parameters();
  const double weight = model.weight_n(), buoyancy = p.buoyancy_n * under.hull;
  const Axes center_of_buoyancy = p.center_of_buoyancy_m + Axes(under.x_shift_m, 0, 0);
  return {(weight - buoyancy) * down,
          cross(weight * Axes(p.center_of_gravity_m) - buoyancy * center_of_buoyancy, down)};
}

// Force of the buoyancy engine and moment of the moving mass: the extra volume V at r_e lifts by rho g V, and
// the mass m_p displaced by x adds m_p g x to the moment of the weight.
//
//   X = -rho g V d,  K = (m_p g (x, 0, 0) - rho g V r_e) x d
BodyForce ballast_force(const ModelParameters& p, const ActuatorValues& actuators, const Axes& down,
                        double submerged_share) {
  const double lift_n = p.water_density_kg_m3 * p.gravity_m_s2 * actuators.buoyancy_m3 * submerged_share;
  const Axes shift(p.moving_mass.mass_kg * p.gravity_m_s2 * actuators.moving_mass_m, 0, 0);
  return {-lift_n * down, cross(shift - lift_n * Axes(p.buoyancy_engine.position_m), down)};
}

BodyForce total_coriolis_force(const Model& model, const BodyVelocity& nu_r) {
  const ModelParameters& p = model.parameters();
  if (p.added_mass_coriolis == AddedMassCoriolis::kFull) return coriolis_force(model.mass(), nu_r);
  return coriolis_force(model.rigid_body_mass(), nu_r) + roll_only_coriolis_force(p.added_mass, nu_r);
}

// Equations of motion (Fossen 2021, section 10.3), with nu_c the velocity of the current in the body frame.
// The forces are those of hull_forces.h and actuator_forces.h. Hydrodynamic forces are scaled by the
// submerged share of the hull.
//
//   M nu_r_dot = tau - C(nu_r) nu_r - D(nu_r) nu_r - g(eta)
//   nu_dot     = nu_r_dot + nu_c_dot
BodyVelocity acceleration(const Model& model, const Numbers& state, const WorldAxes& axes,
                          const Water& water) {
  const ModelParameters& p = model.parameters();
  const RelativeFlow flow = relative_flow(model, state.velocity, axes, water);
  const WetFloats wet = wet_floats(p, state, axes, water);
  const Submergence under =
      p.floats.empty() ? submergence(p, state, water) : Submergence{wet.bottom_share, wet.bottom_share, 0};
  BodyForce of_hull = hull_force(p, flow);
  if (!p.thrusters.empty()) of_hull = of_hull + thrusters_force(p, state, flow);
  BodyForce force = total_coriolis_force(model, flow.nu_r) + under.hull * of_hull +
                    under.stern * stern_force(p, state, flow) + restoring_force(model, axes.down, under);
  if (!p.floats.empty()) force = force + floats_force(model, wet, axes, water);
  if (p.buoyancy_engine.pump.limit > 0 || p.moving_mass.mass_kg > 0)
    force = force + ballast_force(p, state.actuators, axes.down, under.hull);
  const Vec6 a = times(model.inverse_mass(), force);
  return {flow.current_rate + Axes(a[0], a[1], a[2]), Axes(a[3], a[4], a[5])};
}

// Kinematics of the position: p_dot = R v.
Axes position_rate(const WorldAxes& axes, const Axes& v) {
  const Axes &n = axes.north, &e = axes.east, &d = axes.down;
  return {n.x * v.x + n.y * v.y + n.z * v.z, e.x * v.x + e.y * v.y + e.z * v.z,
          d.x * v.x + (d.y * v.y + d.z * v.z)};
}

// Kinematics of the quaternion, coefficients in the order x, y, z, w: q_dot = 1/2 q (0, omega).
std::array<double, 4> quaternion_rate(const std::array<double, 4>& at, const Axes& omega) {
  const double x = at[0], y = at[1], z = at[2], w = at[3], p = omega.x, q = omega.y, r = omega.z;
  return {0.5 * (w * p + y * r - z * q), 0.5 * (w * q + (z * p - x * r)), 0.5 * (w * r - y * p + x * q),
          0.5 * (-(y * q) - (z * r + x * p))};
}

Numbers rate_of_change(const Model& model, const Numbers& state, const ActuatorValues& limited_command,
                       const Water& water) {
  const WorldAxes axes = world_axes(state.orientation);
  return {position_rate(axes, state.velocity.linear()),
          quaternion_rate(state.orientation, state.velocity.angular()),
          acceleration(model, state, axes, water),
          actuator_rate(model.parameters(), state.actuators, limited_command)};
}

ActuatorValues advanced(const ActuatorValues& a, const ActuatorValues& rate, double dt) {
  ActuatorValues next{a.rudder_rad + dt * rate.rudder_rad, a.stern_planes_rad + dt * rate.stern_planes_rad,
                      a.propeller_hz + dt * rate.propeller_hz, a.thruster_hz};
  for (std::size_t i = 0; i < next.thruster_hz.size(); ++i) next.thruster_hz[i] += dt * rate.thruster_hz[i];
  next.buoyancy_m3 = a.buoyancy_m3 + dt * rate.buoyancy_m3;
  next.moving_mass_m = a.moving_mass_m + dt * rate.moving_mass_m;
  next.weight = a.weight;
  return next;
}

Numbers advanced(const Numbers& s, const Numbers& rate, double dt) {
  Numbers next{s.position + dt * rate.position, s.orientation, s.velocity + dt * rate.velocity,
               advanced(s.actuators, rate.actuators, dt)};
  for (std::size_t i = 0; i < 4; ++i) next.orientation[i] += dt * rate.orientation[i];
  return next;
}

// Returns the water `seconds` after the start of the step.
Water after(const Water& water, double seconds) {
  Water later = water;
  later.current_ned_mps += seconds * water.current_rate_ned_mps2;
  later.sea_surface_z_m += seconds * water.surface_rate_mps;
  return later;
}

}  // namespace

RelativeFlow relative_flow(const Model& model, const VehicleState& state, const Water& water) {
  const Numbers s = to_numbers(state);
  return relative_flow(model, s.velocity, world_axes(s.orientation), water);
}

double shaft_power_w(const Model& model, const VehicleState& state, const Water& water) {
  const ModelParameters& p = model.parameters();
  const Numbers s = to_numbers(state);
  const RelativeFlow flow = relative_flow(model, state, water);
  const double wet = p.floats.empty() ? 0 : wet_floats(p, s, world_axes(s.orientation), water).bottom_share;
  const Submergence under = p.floats.empty() ? submergence(p, s, water) : Submergence{wet, wet, 0};
  double power_w = under.stern * shaft_power_w(p.propeller, p.water_density_kg_m3, flow.nu_r,
                                               inflow_speed_mps(p, s, flow), s.actuators.propeller_hz);
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    power_w += under.hull * shaft_power_w(p.thrusters[i], p.water_density_kg_m3, flow.nu_r, flow.speed_mps,
                                          s.actuators.thruster_hz[i]);
  }
  return power_w;
}

Vec6 acceleration(const Model& model, const VehicleState& state, const Water& water) {
  const Numbers s = to_numbers(state);
  return acceleration(model, s, world_axes(s.orientation), water).vector();
}

StateRate rate_of_change(const Model& model, const VehicleState& state, const ActuatorValues& limited_command,
                         const Water& water) {
  const Numbers rate = rate_of_change(model, to_numbers(state), limited_command, water);
  return {Vec3(rate.position.x, rate.position.y, rate.position.z), Eigen::Vector4d(rate.orientation.data()),
          rate.velocity.vector(), rate.actuators};
}

// Classical Runge-Kutta method of order 4; the quaternion is normalised after the step.
//
//   y <- y + h / 6 (k_1 + 2 k_2 + 2 k_3 + k_4)
VehicleState rk4_step(const Model& model, const VehicleState& state, const ActuatorValues& command,
                      const Water& water, double step_s) {
  const ActuatorValues held = limited(model.parameters(), command);
  const Water halfway = after(water, step_s / 2), at_end = after(water, step_s);
  const Numbers start = to_numbers(state);
  const Numbers k1 = rate_of_change(model, start, held, water);
  const Numbers k2 = rate_of_change(model, advanced(start, k1, step_s / 2), held, halfway);
  const Numbers k3 = rate_of_change(model, advanced(start, k2, step_s / 2), held, halfway);
  const Numbers k4 = rate_of_change(model, advanced(start, k3, step_s), held, at_end);
  const Numbers sum = advanced(advanced(advanced(k1, k2, 2), k3, 2), k4, 1);
  Numbers end = advanced(start, sum, step_s / 6);
  end.actuators.weight = std::max(state.actuators.weight, held.weight);  // stays released
  return {Vec3(end.position.x, end.position.y, end.position.z),
          Quaternion(end.orientation.data()).normalized(), end.velocity.vector(), end.actuators};
}

}  // namespace halocline::vehicle_sim
