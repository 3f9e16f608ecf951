// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/vehicle_model.h"

#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/check.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kLargest = 1e12;  // far above any vehicle; excludes infinities
constexpr double kMin = 1e-12;     // smallest value that counts as above 0

void require_positive(double value, const char* what, const char* unit) {
  require_in_range(value, kMin, kLargest, what, unit);
}

void require_not_negative(double value, const char* what, const char* unit) {
  require_in_range(value, 0, kLargest, what, unit);
}

void check_body(const ModelParameters& p) {
  require_positive(p.water_density_kg_m3, "water density", "kg/m^3");
  require_positive(p.gravity_m_s2, "gravity", "m/s^2");
  require_positive(p.hull.length_m, "hull length", "m");
  require_in_range(p.hull.diameter_m, kMin, p.hull.length_m, "hull diameter", "m");
  require_positive(p.mass_kg, "mass", "kg");
  require_not_negative(p.buoyancy_n, "buoyancy", "N");
  require(p.center_of_gravity_m.allFinite(), "the centre of gravity is not finite");
  require(p.center_of_buoyancy_m.allFinite(), "the centre of buoyancy is not finite");
  require(p.leak_offset_m.allFinite(), "the place of a leak's water is not finite");
  require(p.transducer_m.allFinite(), "the place of the transducer is not finite");
}

void check_floats(const std::vector<Float>& floats) {
  require(floats.size() <= kMaxFloats, "a vehicle has 16 floats at most");
  for (const Float& f : floats) {
    require(f.bottom_m.allFinite(), "the place of a float is not finite");
    require_positive(f.length_m, "float length", "m");
    require_positive(f.beam_m, "float beam", "m");
    require_positive(f.height_m, "float height", "m");
  }
}

void check_forces(const ModelParameters& p) {
  require((p.damping.linear.array() >= 0).all(), "a damping coefficient is negative");
  require((p.damping.decay_s_per_m.array() >= 0).all(), "a damping decay is negative");
  require_not_negative(p.lift_drag.reference_area_m2, "lift reference area", "m^2");
  require_not_negative(p.lift_drag.zero_lift_drag, "zero-lift drag coefficient", "");
  require_positive(p.lift_drag.aspect_ratio, "aspect ratio", "");
  require_in_range(p.lift_drag.oswald_efficiency, kMin, 1, "Oswald efficiency", "");
  require_finite(p.lift_drag.x_m, "place of the lift");
  require_not_negative(p.lift_drag.broadside_drag, "broadside drag coefficient", "");
  require_not_negative(p.body_lift.reference_area_m2, "body lift reference area", "m^2");
  require_not_negative(p.body_lift.axial_drag, "axial drag coefficient", "");
  require_not_negative(p.body_lift.lift_slope_per_rad, "body lift slope", "1/rad");
  require_not_negative(p.body_lift.center_aft_m, "centre of body lift", "m");
  require_not_negative(p.cross_flow.drag_coefficient, "cross-flow drag coefficient", "");
  require_not_negative(p.cross_flow.strip_length_m, "cross-flow strip length", "m");
  require_in_range(p.cross_flow.strips, 0, 1000, "cross-flow strips", "");
}

void check_fins(const FinPair& fins) {
  require_not_negative(fins.area_m2, "fin area", "m^2");
  require_not_negative(fins.lift_slope_per_rad, "fin lift slope", "1/rad");
  require_not_negative(fins.normal_drag, "fin normal drag", "");
  require_finite(fins.x_m, "place of the fins");
}

void check_thruster(const Thruster& t) {
  constexpr double kUnitTolerance = 1e-6;
  require(t.position_m.allFinite(), "the place of a thruster is not finite");
  require_in_range(t.direction.norm(), 1 - kUnitTolerance, 1 + kUnitTolerance,
                   "length of a thruster's direction");
  require_not_negative(t.diameter_m, "propeller diameter", "m");
  require_not_negative(t.advance_speed_ratio, "advance speed ratio", "");
  for (const double k :
       {t.thrust_at_rest, t.thrust_at_max, t.torque_at_rest, t.torque_at_max, t.torque_share})
    require_finite(k, "propeller coefficient");
  require_positive(t.advance_max, "greatest advance number", "");
  require_in_range(t.thrust_share, 0, 1, "thrust share", "");
  require_in_range(t.astern_ratio, 0, 1, "astern ratio", "");
  require_positive(t.lag_s, "propeller lag", "s");
  require_not_negative(t.max_hz, "greatest propeller speed", "Hz");
}

void check_slow(const SlowActuator& a, const char* what) {
  require_not_negative(a.limit, what, "");
  require_not_negative(a.rate, what, "");
  require_positive(a.lag_s, what, "s");
}

void check_ballast(const ModelParameters& p) {
  check_slow(p.buoyancy_engine.pump, "buoyancy engine");
  require(p.buoyancy_engine.position_m.allFinite(), "the place of the buoyancy engine is not finite");
  require_not_negative(p.moving_mass.mass_kg, "moving mass", "kg");
  check_slow(p.moving_mass.drive, "moving mass");
  require_in_range(p.drop_weight.mass_kg, 0, p.mass_kg, "drop weight", "kg");
  require_in_range(p.drop_weight.buoyancy_n, 0, p.buoyancy_n, "buoyancy of the drop weight", "N");
  require(p.drop_weight.position_m.allFinite(), "the place of the drop weight is not finite");
}

void check_actuators(const ModelParameters& p) {
  check_fins(p.rudder);
  check_fins(p.stern_planes);
  require_positive(p.fin_servo.lag_s, "fin lag", "s");
  require_in_range(p.fin_servo.max_angle_rad, 0, std::numbers::pi / 2, "greatest fin angle", "rad");
  check_thruster(p.propeller);
  require(p.thrusters.size() <= kMaxThrusters, "a vehicle has 4 thrusters at most besides its propeller");
  for (const Thruster& thruster : p.thrusters) check_thruster(thruster);
}

}  // namespace

// Returns the cross-product matrix: S(a) b = a x b.
Mat3 skew(const Vec3& a) {
  Mat3 s;
  s << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return s;
}

// Rigid-body mass matrix about CO (Fossen 2021, eq. 3.35):
//
//   M_RB = H(r_g)^T diag(m I, I_g) H(r_g),  H(r) = [I, S(r)^T; 0, I]
Mat6 rigid_body_mass_matrix(double mass_kg, const Mat3& inertia_kg_m2, const Vec3& center_of_gravity_m) {
  Mat6 about_cg = Mat6::Zero();
  about_cg.topLeftCorner<3, 3>() = mass_kg * Mat3::Identity();
  about_cg.bottomRightCorner<3, 3>() = inertia_kg_m2;
  Mat6 h = Mat6::Identity();
  h.topRightCorner<3, 3>() = skew(center_of_gravity_m).transpose();
  return h.transpose() * about_cg * h;
}

Model::Model(ModelParameters parameters) : parameters_(std::move(parameters)) {
  check_body(parameters_);
  check_floats(parameters_.floats);
  check_forces(parameters_);
  check_actuators(parameters_);
  check_ballast(parameters_);
  rigid_body_mass_ =
      rigid_body_mass_matrix(parameters_.mass_kg, parameters_.inertia_kg_m2, parameters_.center_of_gravity_m);
  mass_ = rigid_body_mass_ + parameters_.added_mass;
  require(mass_.allFinite() && mass_.isApprox(mass_.transpose()), "the mass matrix is not symmetric");
  require(mass_.llt().info() == Eigen::Success, "the mass matrix is not positive definite");
  inverse_mass_ = mass_.inverse();
  if (parameters_.drop_weight.mass_kg > 0) Model{without_weight(parameters_)};  // throws when not possible
}

// Body without a point mass m_w at r_w, by the parallel axis theorem about the new centre of gravity:
//
//   m'    = m - m_w
//   m' r' = m r - m_w r_w
//   I'    = I - (m m_w / m') (d^2 1 - d d^T),  d = r_w - r
ModelParameters without_weight(ModelParameters p) {
  const DropWeight weight = p.drop_weight;
  if (weight.mass_kg == 0) return p;
  const double rest_kg = p.mass_kg - weight.mass_kg, rest_n = p.buoyancy_n - weight.buoyancy_n;
  require_positive(rest_kg, "mass without the drop weight", "kg");
  const Vec3 d = weight.position_m - p.center_of_gravity_m;
  p.inertia_kg_m2 -=
      p.mass_kg * weight.mass_kg / rest_kg * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  p.center_of_gravity_m -= weight.mass_kg / rest_kg * d;
  if (rest_n > 0)
    p.center_of_buoyancy_m -= weight.buoyancy_n / rest_n * (weight.position_m - p.center_of_buoyancy_m);
  p.mass_kg = rest_kg;
  p.buoyancy_n = rest_n;
  p.drop_weight = {};
  return p;
}

}  // namespace halocline::vehicle_sim
