// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/remus100_pvs.h"

#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "core/units.h"
#include "vehicle_sim/dynamics/actuators.h"

namespace halocline::vehicle_sim {
namespace {

using std::numbers::pi;

constexpr double kDensity = 1026, kGravity = 9.81;  // kg/m^3, m/s^2
constexpr double kLength = 1.6, kDiameter = 0.19;   // m
constexpr double kSemiAxial = kLength / 2, kSemiTransverse = kDiameter / 2;
constexpr double kMetacentre = 0.02;                                              // m, CG below CB
constexpr double kRollAddedInertia = 0.3;                                         // A_44 / I_x
constexpr double kSurgeTime = 20, kSwayTime = 20, kHeaveTime = 20, kYawTime = 1;  // s: damping = M_kk / time
constexpr double kRollDampingRatio = 0.3, kPitchDampingRatio = 0.8;
constexpr double kDampingDecay = 3;         // s/m, decay of surge and sway damping
constexpr double kHullZeroLiftDrag = 0.42;  // drag coefficient on the frontal area
constexpr double kPlanformShare = 0.7;      // reference area / (length times diameter)
constexpr double kOswald = 0.7;
// Section drag at breadth over twice draft = 1/2 (Hoerner 1965).
constexpr double kHoernerHalf = 1.1977288343558283;
constexpr int kStripIntervals = 20;
constexpr double kFinArea = 0.00665;                   // m^2, one fin
constexpr double kFinPlace = -0.8;                     // m
constexpr double kRudderLift = 0.5, kSternLift = 0.7;  // 1/rad
constexpr double kMaxFinDegrees = 15, kMaxRpm = 1525;

// Added masses (Fossen 2021, section 8.1.5), and K_p = -0.3 I_x:
//
//   X_u = -k_1 m,  Y_v = Z_w = -k_2 m,  M_q = N_r = -k' I
Mat6 added_mass(double mass, const Vec3& inertia) {
  const LambFactors k = lamb_factors(kSemiAxial, kSemiTransverse);
  Vec6 diagonal;
  diagonal << k.axial * mass, k.transverse * mass, k.transverse * mass, kRollAddedInertia * inertia.x(),
      k.rotational * inertia.y(), k.rotational * inertia.z();
  return diagonal.asDiagonal();
}

// Linear damping (the published program, after Fossen 2021, section 6.4): by time constants T_k in surge,
// sway, heave and yaw, by damping ratios zeta_k at the natural frequencies w_k in roll and pitch:
//
//   D_kk = M_kk / T_k
//   D_kk = 2 zeta_k w_k M_kk,  w_k = sqrt(W z_g / M_kk)
Damping damping(const Mat6& m, double weight) {
  const double roll_frequency = std::sqrt(weight * kMetacentre / m(3, 3));
  const double pitch_frequency = std::sqrt(weight * kMetacentre / m(4, 4));
  Damping d;
  d.linear << m(0, 0) / kSurgeTime, m(1, 1) / kSwayTime, m(2, 2) / kHeaveTime,
      m(3, 3) * 2 * kRollDampingRatio * roll_frequency, m(4, 4) * 2 * kPitchDampingRatio * pitch_frequency,
      m(5, 5) / kYawTime;
  d.decay_s_per_m.head<2>().setConstant(kDampingDecay);
  return d;
}

// Lift slope of a wing of low aspect ratio A (Helmbold), with C_D0 converted from the frontal to the
// reference area S:
//
//   C_La = pi A / (1 + sqrt(1 + (A / 2)^2)),  A = b^2 / S
LiftDrag lift_drag() {
  LiftDrag l;
  l.reference_area_m2 = kPlanformShare * kLength * kDiameter;
  l.zero_lift_drag = kHullZeroLiftDrag * pi * kSemiTransverse * kSemiTransverse / l.reference_area_m2;
  l.aspect_ratio = kDiameter * kDiameter / l.reference_area_m2;
  l.lift_slope_per_rad = pi * l.aspect_ratio / (1 + std::sqrt(1 + elementary::pow(l.aspect_ratio / 2, 2)));
  l.oswald_efficiency = kOswald;
  return l;
}

// Propeller of Allen et al. 2000, with the wake fraction and thrust deduction of the published program.
Thruster propeller() {
  Thruster t;
  t.position_m = {kFinPlace, 0, 0};
  t.diameter_m = 0.14;
  t.inflow = ThrusterInflow::kSpeed;
  t.advance_speed_ratio = 0.944;
  t.thrust_at_rest = 0.4566;
  t.thrust_at_max = 0.1798;
  t.torque_at_rest = 0.0700;
  t.torque_at_max = 0.0312;
  t.advance_max = 0.6632;
  t.thrust_share = 0.9;
  t.torque_share = 0.1;
  t.lag_s = 1.0;
  t.max_hz = kMaxRpm / 60;
  return t;
}

}  // namespace

// Lamb's factors (Lamb 1932, sections 114 and 115; Fossen 2021, section 8.1.5), with the eccentricity e:
//
//   e       = sqrt(1 - (b / a)^2)
//   alpha_0 = 2 (1 - e^2) / e^3 (1/2 ln((1 + e) / (1 - e)) - e)
//   beta_0  = 1 / e^2 - (1 - e^2) / (2 e^3) ln((1 + e) / (1 - e))
//   k_1     = alpha_0 / (2 - alpha_0)
//   k_2     = beta_0 / (2 - beta_0)
//   k'      = e^4 (beta_0 - alpha_0) / ((2 - e^2) (2 e^2 - (2 - e^2) (beta_0 - alpha_0)))
LambFactors lamb_factors(double a, double b) {
  require(b > 0 && a > b, "Lamb's factors need 0 < transverse < axial semi-axis");
  const double e2 = 1 - (b / a) * (b / a), e = std::sqrt(e2);
  const double half_log = 0.5 * elementary::log((1 + e) / (1 - e));
  const double alpha0 = 2 * (1 - e2) / (e * e2) * (half_log - e);
  const double beta0 = 1 / e2 - (1 - e2) / (e * e2) * half_log;
  return {alpha0 / (2 - alpha0), beta0 / (2 - beta0),
          e2 * e2 * (beta0 - alpha0) / ((2 - e2) * (2 * e2 - (2 - e2) * (beta0 - alpha0)))};
}

ModelParameters remus100_pvs_parameters(CurrentTreatment treatment) {
  constexpr double a = kSemiAxial, b = kSemiTransverse;
  ModelParameters p;
  p.name = kRemus100PvsName;
  p.water_density_kg_m3 = kDensity;
  p.gravity_m_s2 = kGravity;
  p.hull = {kLength, kDiameter};
  // A neutrally buoyant solid spheroid:
  //
  //   m = 4/3 pi rho a b^2,  I_x = 2/5 m b^2,  I_y = I_z = m (a^2 + b^2) / 5
  p.mass_kg = 4.0 / 3 * pi * kDensity * a * b * b;
  p.buoyancy_n = p.mass_kg * kGravity;
  p.center_of_gravity_m = {0, 0, kMetacentre};
  const Vec3 inertia(0.4 * p.mass_kg * b * b, p.mass_kg * (a * a + b * b) / 5,
                     p.mass_kg * (a * a + b * b) / 5);
  p.inertia_kg_m2 = inertia.asDiagonal();
  p.added_mass = added_mass(p.mass_kg, inertia);
  const Mat6 m = rigid_body_mass_matrix(p.mass_kg, p.inertia_kg_m2, p.center_of_gravity_m) + p.added_mass;
  p.added_mass_coriolis = AddedMassCoriolis::kRollOnly;
  p.current_treatment = treatment;
  p.damping = damping(m, p.mass_kg * kGravity);
  p.lift_drag = lift_drag();
  p.cross_flow = {kHoernerHalf, kLength / kStripIntervals, kStripIntervals + 1, CrossFlowPlanes::kSway};
  p.rudder = {2 * kFinArea, kRudderLift, kFinPlace, FinLaw::kDeflection};
  p.stern_planes = {2 * kFinArea, kSternLift, kFinPlace, FinLaw::kDeflection};
  p.fin_servo = {0.1, to_radians(kMaxFinDegrees)};
  p.propeller = propeller();
  return p;
}

}  // namespace halocline::vehicle_sim
