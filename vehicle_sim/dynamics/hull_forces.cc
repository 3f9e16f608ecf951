// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/hull_forces.h"

#include <numbers>

namespace halocline::vehicle_sim {

// Kirchhoff's equations (Fossen 2021, eq. 3.46) with the momenta
//
//   a = M_11 v + M_12 omega,  h = M_21 v + M_22 omega
//
// but without the elements of C that couple translation with pitch and yaw.
BodyForce roll_only_coriolis_force(const Mat6& mass, const BodyVelocity& nu) {
  const Vec6 momentum = times(mass, nu);
  const Axes h = {momentum[3], momentum[4], momentum[5]};
  const double a2 = momentum[1], a3 = momentum[2];
  // Rows of C in translation: 2 is -a3 p, 3 is +a2 p. Row 4 in rotation is a3 v - a2 w, added to omega x h.
  return {{0, a3 * nu.p, -a2 * nu.p}, cross(h, nu.angular()) + Axes(a2 * nu.w - a3 * nu.v, 0, 0)};
}

// Lift and drag of the angle of attack (Fossen 2021, eq. 8.23 to 8.26):
//
//   L = 1/2 rho V_r^2 S C_L,  C_L = C_La alpha
//   D = 1/2 rho V_r^2 S C_D,  C_D = C_D0 + C_L^2 / (pi e A)
//   X = -D cos(alpha) + L sin(alpha)
//   Z = -D sin(alpha) - L cos(alpha)
BodyForce lift_drag_force(const LiftDrag& l, double density, const BodyVelocity& nu_r,
                          double relative_speed_mps) {
  if (l.law == LiftLaw::kBounded) return bounded_lift_force(l, density, nu_r);
  const double u = nu_r.u, w = nu_r.w + 0.0;  // turns -0 into +0: one branch of atan2 for both
  const double alpha = elementary::atan2(w, u);
  const double in_plane = std::sqrt(u * u + w * w);
  const double cos_alpha = in_plane > 0 ? u / in_plane : 1, sin_alpha = in_plane > 0 ? w / in_plane : 0;
  const double cl = l.lift_slope_per_rad * alpha;
  const double cd = l.zero_lift_drag + cl * cl / (std::numbers::pi * l.oswald_efficiency * l.aspect_ratio);
  const double dynamic_force = 0.5 * density * relative_speed_mps * relative_speed_mps * l.reference_area_m2;
  const double lift = dynamic_force * cl, drag = dynamic_force * cd;
  return {-cos_alpha * drag + sin_alpha * lift, 0, -sin_alpha * drag - cos_alpha * lift, 0, 0, 0};
}

// Lift and drag bounded at every angle of attack, with w the velocity across the axis at x and V^2 = u^2 +
// w^2:
//
//   X = -1/2 rho S (C_D V u - a u w^2 / V)
//   Z = -1/2 rho S (C_D V w + a u^2 w / V),  M = -x Z
//   C_D = C_D0 + k s / (1 + b s),  s = w^2 / V^2,  k = a^2 / (pi e AR),  b = k / broadside_drag - 1
BodyForce bounded_lift_force(const LiftDrag& l, double density, const BodyVelocity& nu_r) {
  const double u = nu_r.u, w = nu_r.w - l.x_m * nu_r.q;
  const double speed_squared = u * u + w * w;
  if (speed_squared == 0) return {};
  const double slope = l.lift_slope_per_rad;
  const double induced = slope * slope / (std::numbers::pi * l.oswald_efficiency * l.aspect_ratio);
  const double bend = l.broadside_drag > 0 ? induced / l.broadside_drag - 1 : 0;
  const double sine_squared = w * w / speed_squared;
  const double drag = speed_squared * (l.zero_lift_drag + induced * sine_squared / (1 + bend * sine_squared));
  const double scale = -0.5 * density * l.reference_area_m2 / std::sqrt(speed_squared);
  const double z = scale * (drag * w + slope * u * u * w);
  return {scale * (drag * u - slope * u * w * w), 0, z, 0, -l.x_m * z, 0};
}

// Cross-flow drag by strip theory (Fossen 2021, eq. 6.91 and 6.92), as sums over strips; the common factor
// -1/2 rho D C_d dx is applied in cross_flow_force.
//
//   Y = -1/2 rho D C_d integral |v + x r| (v + x r) dx
//   N = -1/2 rho D C_d integral x |v + x r| (v + x r) dx
BodyForce cross_flow_in_sway(const CrossFlow& c, const BodyVelocity& nu_r) {
  const double v = nu_r.v, r = nu_r.r;
  const bool odd = c.strips % 2 == 1;
  double sway = odd ? std::abs(v) * v : 0, yaw = 0;  // sums of |v + x r| (v + x r) and of x times that
  const double innermost = odd ? c.strip_length_m : c.strip_length_m / 2;
  for (int i = 0; i < c.strips / 2; ++i) {  // the strips at x and -x
    const double x = innermost + i * c.strip_length_m;
    const double fore = v + x * r, aft = v - x * r;
    const double fore_square = std::abs(fore) * fore, aft_square = std::abs(aft) * aft;
    sway += fore_square + aft_square;
    yaw += x * (fore_square - aft_square);
  }
  return {0, sway, 0, 0, 0, yaw};
}

}  // namespace halocline::vehicle_sim
