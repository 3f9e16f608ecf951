// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/hover.h"

#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "core/frames.h"
#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

using std::numbers::pi;

constexpr double kDensity = 1026, kGravity = 9.81;  // kg/m^3, m/s^2
constexpr double kLength = 1.4, kDiameter = 0.35;   // m
constexpr double kSemiAxial = kLength / 2, kSemiTransverse = kDiameter / 2;
constexpr double kMetacentre = 0.02;             // m, CG below CB
constexpr double kRollAddedInertia = 0.3;        // A_44 / I_x, the value of remus100-pvs
constexpr double kSpeedTime = 20, kYawTime = 1;  // s: damping = M_kk / time, the values of remus100-pvs
constexpr double kRollDampingRatio = 0.3, kPitchDampingRatio = 0.8;  // the values of remus100-pvs
constexpr double kDampingDecay = 3;                                  // s/m
constexpr double kFrontalDrag = 0.3;  // on the frontal area: a blunt spheroid with thrusters and openings
constexpr double kBodyLiftOnDiameter = 1.2, kLiftCenterFromNose = 0.65, kSectionDrag = 1.1;  // from torpedo
constexpr int kStrips = 10;
constexpr double kBesideAxis = 0.25, kAftOfMiddle = 0.45;  // m, positions of the thrusters

Thruster thruster_at(const Vec3& position, const Vec3& direction) {
  Thruster t;
  t.position_m = position;
  t.direction = direction;
  t.diameter_m = 0.076;
  t.advance_speed_ratio = 1;
  t.max_hz = 60;
  // Bollard thrust T = K_T0 rho n^2 D^4: 51.5 N at 60 Hz.
  t.thrust_at_rest = 51.5 / (kDensity * elementary::pow(t.max_hz, 2) * elementary::pow(t.diameter_m, 4));
  t.thrust_at_max = 0.3 * t.thrust_at_rest;  // ducted propellers of unit pitch, Oosterveld 1970
  t.advance_max = 0.6;
  t.torque_at_rest = t.torque_at_max = 0.04;
  t.torque_share = 0.1;
  t.astern_ratio = 0.78;
  t.lag_s = 0.15;
  return t;
}

// Added masses by Lamb's factors (Lamb 1932, sections 114 and 115), and K_p as a share of I_x:
//
//   X_u = -k_1 m,  Y_v = Z_w = -k_2 m,  M_q = N_r = -k' I
Vec6 added_mass_diagonal(double mass, const Vec3& inertia) {
  const LambFactors k = lamb_factors(kSemiAxial, kSemiTransverse);
  Vec6 diagonal;
  diagonal << k.axial * mass, k.transverse * mass, k.transverse * mass, kRollAddedInertia * inertia.x(),
      k.rotational * inertia.y(), k.rotational * inertia.z();
  return diagonal;
}

// Linear damping (Fossen 2021, section 6.4): by time constants T_k in surge, sway, heave and yaw, by damping
// ratios zeta_k in roll and pitch:
//
//   D_kk = M_kk / T_k
//   D_kk = 2 zeta_k sqrt(W z_g M_kk)
Damping damping(const Vec6& m, double weight) {
  Damping d;
  d.linear << m[0] / kSpeedTime, m[1] / kSpeedTime, m[2] / kSpeedTime,
      2 * kRollDampingRatio * std::sqrt(weight * kMetacentre * m[3]),
      2 * kPitchDampingRatio * std::sqrt(weight * kMetacentre * m[4]), m[5] / kYawTime;
  d.decay_s_per_m.head<3>().setConstant(kDampingDecay);
  return d;
}

}  // namespace

ModelParameters hover_parameters() {
  constexpr double a = kSemiAxial, b = kSemiTransverse;
  ModelParameters p;
  p.name = kHoverName;
  p.water_density_kg_m3 = kDensity;
  p.gravity_m_s2 = kGravity;
  p.hull = {kLength, kDiameter};
  // A solid spheroid of the density of the water:
  //
  //   m = 4/3 pi rho a b^2,  I_x = 2/5 m b^2,  I_y = I_z = m (a^2 + b^2) / 5
  p.mass_kg = 4.0 / 3 * pi * kDensity * a * b * b;
  p.buoyancy_n = p.mass_kg * kGravity;
  p.center_of_gravity_m = {0, 0, kMetacentre};
  const double across = p.mass_kg * (a * a + b * b) / 5;
  const Vec3 inertia(0.4 * p.mass_kg * b * b, across, across);
  p.inertia_kg_m2 = inertia.asDiagonal();
  const Vec6 added = added_mass_diagonal(p.mass_kg, inertia);
  p.added_mass = added.asDiagonal();
  const Mat6 rigid = rigid_body_mass_matrix(p.mass_kg, p.inertia_kg_m2, p.center_of_gravity_m);
  p.damping = damping(rigid.diagonal() + added, p.mass_kg * kGravity);
  // The lift slope refers to the diameter squared: C_L,d d^2 = C_L S.
  p.body_lift = {.reference_area_m2 = pi * b * b,
                 .axial_drag = kFrontalDrag,
                 .lift_slope_per_rad = kBodyLiftOnDiameter * kDiameter * kDiameter / (pi * b * b),
                 .center_aft_m = (kLiftCenterFromNose - 0.5) * kLength};
  p.cross_flow = {kSectionDrag, kLength / kStrips, kStrips, CrossFlowPlanes::kBoth};
  p.thrusters = {thruster_at({-kAftOfMiddle, -kBesideAxis, 0}, Vec3::UnitX()),
                 thruster_at({-kAftOfMiddle, kBesideAxis, 0}, Vec3::UnitX()),
                 thruster_at({kAftOfMiddle, 0, 0}, Vec3::UnitZ()),
                 thruster_at({-kAftOfMiddle, 0, 0}, Vec3::UnitZ())};
  return p;
}

}  // namespace halocline::vehicle_sim
