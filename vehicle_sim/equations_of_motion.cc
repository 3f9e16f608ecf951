#include "vehicle_sim/equations_of_motion.h"

#include <cmath>

#include "vehicle_sim/actuator_forces.h"
#include "vehicle_sim/hull_forces.h"
#include "vehicle_sim/submergence.h"

namespace halocline::vehicle_sim {
namespace {

// u_c = V cos(beta - psi), v_c = V sin(beta - psi), w_c = 0; (cos psi, sin psi) is the heading of the body's
// x axis.
Vec3 current_turned_by_yaw(const Mat3& body_to_world, const Vec3& current_ned) {
  const double north = body_to_world(0, 0), east = body_to_world(1, 0), level = std::hypot(north, east);
  const double cos_yaw = level > 0 ? north / level : 1, sin_yaw = level > 0 ? east / level : 0;
  return {cos_yaw * current_ned.x() + sin_yaw * current_ned.y(),
          cos_yaw * current_ned.y() - sin_yaw * current_ned.x(), 0};
}

RelativeFlow relative_flow(const Model& model, const Vec6& nu, const Mat3& body_to_world,
                           const Water& water) {
  RelativeFlow flow{nu};
  if (!water.current_ned_mps.isZero(0) || !water.current_rate_ned_mps2.isZero(0)) {
    const bool by_yaw = model.parameters().current_treatment == CurrentTreatment::kUpstream;
    const auto to_body = [&](const Vec3& v) {
      return by_yaw ? current_turned_by_yaw(body_to_world, v) : Vec3(body_to_world.transpose() * v);
    };
    const Vec3 current = to_body(water.current_ned_mps);
    const Vec3 turn = by_yaw ? Vec3(0, 0, nu[5]) : Vec3(nu.tail<3>());
    flow.nu_r.head<3>() -= current;
    flow.current_rate.head<3>() = current.cross(turn);  // -omega x v_c
    if (!water.current_rate_ned_mps2.isZero(0))
      flow.current_rate.head<3>() += to_body(water.current_rate_ned_mps2);
  }
  flow.speed_mps = flow.nu_r.head<3>().norm();
  return flow;
}

Vec6 hull_force(const ModelParameters& p, const RelativeFlow& flow) {
  const double rho = p.water_density_kg_m3;
  Vec6 force = damping_force(p.damping, flow.nu_r, flow.speed_mps) +
               cross_flow_force(p.cross_flow, rho, p.hull.diameter_m, flow.nu_r);
  if (p.lift_drag.reference_area_m2 > 0)
    force += lift_drag_force(p.lift_drag, rho, flow.nu_r, flow.speed_mps);
  if (p.body_lift.reference_area_m2 > 0) force += body_lift_force(p.body_lift, rho, flow.nu_r);
  return force;
}

Vec6 stern_force(const ModelParameters& p, const VehicleState& state, const RelativeFlow& flow) {
  const double rho = p.water_density_kg_m3;
  const double inflow_speed = p.current_treatment == CurrentTreatment::kUpstream
                                  ? state.linear_velocity_body_mps().norm()
                                  : flow.speed_mps;
  return rudder_force(p.rudder, rho, flow.nu_r, state.actuators.rudder_rad) +
         stern_planes_force(p.stern_planes, rho, flow.nu_r, state.actuators.stern_planes_rad) +
         thruster_force(p.propeller, rho, flow.nu_r, inflow_speed, state.actuators.propeller_hz);
}

Vec6 thrusters_force(const ModelParameters& p, const VehicleState& state, const RelativeFlow& flow) {
  Vec6 force = Vec6::Zero();
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    force += thruster_force(p.thrusters[i], p.water_density_kg_m3, flow.nu_r, flow.speed_mps,
                            state.actuators.thruster_hz[i]);
  }
  return force;
}

// Weight at CG, buoyancy at CB; `down` is the world's z axis in the body frame.
Vec6 restoring_force(const Model& model, const Vec3& down, const Submergence& under) {
  const ModelParameters& p = model.parameters();
  const double buoyancy = p.buoyancy_n * under.hull;
  const Vec3 center_of_buoyancy = p.center_of_buoyancy_m + under.x_shift_m * Vec3::UnitX();
  Vec6 force;
  force << (model.weight_n() - buoyancy) * down,
      (model.weight_n() * p.center_of_gravity_m - buoyancy * center_of_buoyancy).cross(down);
  return force;
}

Vec6 total_coriolis_force(const Model& model, const Vec6& nu_r) {
  const ModelParameters& p = model.parameters();
  if (p.added_mass_coriolis == AddedMassCoriolis::kFull) return coriolis_force(model.mass(), nu_r);
  return coriolis_force(model.rigid_body_mass(), nu_r) + roll_only_coriolis_force(p.added_mass, nu_r);
}

Vec6 acceleration(const Model& model, const VehicleState& state, const Mat3& body_to_world,
                  const Water& water) {
  const ModelParameters& p = model.parameters();
  const RelativeFlow flow = relative_flow(model, state.velocity_body, body_to_world, water);
  const Submergence under = submergence(p, state, water.sea_surface_z_m);
  const Vec6 force = total_coriolis_force(model, flow.nu_r) +
                     under.hull * (hull_force(p, flow) + thrusters_force(p, state, flow)) +
                     under.stern * stern_force(p, state, flow) +
                     restoring_force(model, body_to_world.row(2).transpose(), under);
  return flow.current_rate + model.inverse_mass() * force;
}

// q_dot = 1/2 q (0, omega), coefficients x, y, z, w.
Eigen::Vector4d quaternion_rate(const Quaternion& q, const Vec3& omega) {
  return 0.5 * (q * Quaternion(0, omega.x(), omega.y(), omega.z())).coeffs();
}

ActuatorValues advanced(const ActuatorValues& a, const ActuatorValues& rate, double dt) {
  ActuatorValues next{a.rudder_rad + dt * rate.rudder_rad, a.stern_planes_rad + dt * rate.stern_planes_rad,
                      a.propeller_hz + dt * rate.propeller_hz, a.thruster_hz};
  for (std::size_t i = 0; i < next.thruster_hz.size(); ++i) next.thruster_hz[i] += dt * rate.thruster_hz[i];
  return next;
}

VehicleState advanced(const VehicleState& s, const StateRate& rate, double dt) {
  VehicleState next;
  next.position_ned_m = s.position_ned_m + dt * rate.position;
  next.orientation.coeffs() = s.orientation.coeffs() + dt * rate.orientation;
  next.velocity_body = s.velocity_body + dt * rate.velocity;
  next.actuators = advanced(s.actuators, rate.actuators, dt);
  return next;
}

// The water some time into the step.
Water after(const Water& water, double seconds) {
  Water later = water;
  later.current_ned_mps += seconds * water.current_rate_ned_mps2;
  return later;
}

// a + weight b
StateRate plus(const StateRate& a, const StateRate& b, double weight) {
  return {a.position + weight * b.position, a.orientation + weight * b.orientation,
          a.velocity + weight * b.velocity, advanced(a.actuators, b.actuators, weight)};
}

}  // namespace

RelativeFlow relative_flow(const Model& model, const VehicleState& state, const Water& water) {
  return relative_flow(model, state.velocity_body, state.orientation.toRotationMatrix(), water);
}

Vec6 acceleration(const Model& model, const VehicleState& state, const Water& water) {
  return acceleration(model, state, state.orientation.toRotationMatrix(), water);
}

StateRate rate_of_change(const Model& model, const VehicleState& state, const ActuatorValues& limited_command,
                         const Water& water) {
  // Between the stages of a step the quaternion is off unit length by the square of the angle turned.
  const Mat3 body_to_world = state.orientation.normalized().toRotationMatrix();
  return {body_to_world * state.linear_velocity_body_mps(),
          quaternion_rate(state.orientation, state.angular_velocity_body_radps()),
          acceleration(model, state, body_to_world, water),
          actuator_rate(model.parameters(), state.actuators, limited_command)};
}

VehicleState rk4_step(const Model& model, const VehicleState& state, const ActuatorValues& command,
                      const Water& water, double step_s) {
  const ActuatorValues held = limited(model.parameters(), command);
  const Water halfway = after(water, step_s / 2), at_end = after(water, step_s);
  const StateRate k1 = rate_of_change(model, state, held, water);
  const StateRate k2 = rate_of_change(model, advanced(state, k1, step_s / 2), held, halfway);
  const StateRate k3 = rate_of_change(model, advanced(state, k2, step_s / 2), held, halfway);
  const StateRate k4 = rate_of_change(model, advanced(state, k3, step_s), held, at_end);
  const StateRate sum = plus(plus(plus(k1, k2, 2), k3, 2), k4, 1);
  VehicleState next = advanced(state, sum, step_s / 6);
  next.orientation.normalize();
  return next;
}

double mechanical_energy_j(const Model& model, const VehicleState& state) {
  const ModelParameters& p = model.parameters();
  const double kinetic = 0.5 * state.velocity_body.dot(model.mass() * state.velocity_body);
  const auto depth_of = [&](const Vec3& point) {
    return (state.position_ned_m + state.orientation * point).z();
  };
  return kinetic - model.weight_n() * depth_of(p.center_of_gravity_m) +
         p.buoyancy_n * depth_of(p.center_of_buoyancy_m);
}

}  // namespace halocline::vehicle_sim
