// SPDX-License-Identifier: BSD-3-Clause
// Hydrodynamic forces on a moving hull, one function for each effect, in the body frame about CO.
//
// Each function takes the velocity relative to the water, nu_r = (u, v, w, p, q, r) in m/s and rad/s, and
// returns a force and moment in N and N m that stands on the right-hand side of M nu_dot = ... (with its
// sign). Sources are given at each function; equation numbers are those of Fossen 2021. None does positive
// work on a hull in water at rest.
#pragma once

#include <cmath>

#include "core/elementary.h"
#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

// Coriolis and centripetal force by Kirchhoff's equations (eq. 3.46), with the momenta (P, H) = mass nu:
//
//   -C nu = -(omega x P, omega x H + v x P)
//
// It does no work: nu . C nu = 0. `mass` must be symmetric and about CO.
inline BodyForce coriolis_force(const Mat6& mass, const BodyVelocity& nu) {
  const Vec6 momentum = times(mass, nu);
  const Axes v = nu.linear(), w = nu.angular();
  const Axes p = {momentum[0], momentum[1], momentum[2]}, h = {momentum[3], momentum[4], momentum[5]};
  return {cross(p, w), cross(h, w) + cross(p, v)};
}

// The part of coriolis_force in which translation acts through roll alone (AddedMassCoriolis::kRollOnly): the
// elements 15, 16, 35 and 26 of C (rows and columns from 1) and their mirror images are taken as zero. It
// does no work.
BodyForce roll_only_coriolis_force(const Mat6& mass, const BodyVelocity& nu);

// Linear damping -D nu_r with the diagonal matrix D of `damping`; `relative_speed_mps` = |(u, v, w)|.
//
//   D_k = linear_k exp(-decay_k |v_r|)
inline BodyForce damping_force(const Damping& damping, const BodyVelocity& nu_r, double relative_speed_mps) {
  const Vec6& d = damping.linear;
  double share[6] = {1, 1, 1, 1, 1, 1};
  double last_decay = 0, attenuation = 1;
  for (int k = 0; k < 6; ++k) {
    const double decay = damping.decay_s_per_m[k];
    if (decay == 0) continue;
    if (decay != last_decay)
      attenuation = elementary::exp(-decay * relative_speed_mps);  // shared by degrees of freedom
    last_decay = decay;
    share[k] = attenuation;
  }
  return {-d[0] * nu_r.u * share[0], -d[1] * nu_r.v * share[1], -d[2] * nu_r.w * share[2],
          -d[3] * nu_r.p * share[3], -d[4] * nu_r.q * share[4], -d[5] * nu_r.r * share[5]};
}

// Lift across and drag along the flow in the x-z plane (eq. 8.23 to 8.26); `density` in kg/m^3.
// LiftLaw::kAngle: linear in alpha = atan2(w, u) in [-pi, pi], without a moment; a w of -0 counts as +0.
// LiftLaw::kBounded: see bounded_lift_force.
BodyForce lift_drag_force(const LiftDrag& lift_drag, double density, const BodyVelocity& nu_r,
                          double relative_speed_mps);

// Lift and drag that are bounded and smooth at every angle of attack. With the velocity w_l at the point x
// where the force acts, and the angle of attack alpha there:
//
//   w_l  = w - x q
//   V^2  = u^2 + w_l^2,  sin(alpha) = w_l / V,  cos(alpha) = u / V
//   lift = 1/2 rho S V^2 a sin(alpha) cos(alpha)     across the flow
//   drag = 1/2 rho S V^2 C_D                         along the flow
//   C_D  = C_D0 + k s / (1 + b s),  s = sin(alpha)^2
//   k    = a^2 / (pi e AR),  b = k / broadside_drag - 1
//
// so that
//
//   X = -1/2 rho S (C_D V u - a u w_l^2 / V)
//   Z = -1/2 rho S (C_D V w_l + a u^2 w_l / V)
//   M = -x Z
//
// At small angles this is the law of the induced drag, C_D0 + k alpha^2. Lift does no work at x; drag
// dissipates energy at every angle.
BodyForce bounded_lift_force(const LiftDrag& lift_drag, double density, const BodyVelocity& nu_r);

// Drag along a slender hull and lift across it by the sin(alpha) cos(alpha) law (Allen and Perkins 1951, NACA
// 1048; coefficient and position: Hoerner 1965, chapter 19). The lift acts at x_l, center_aft behind the
// middle as the hull moves, where v_l is the velocity across the hull:
//
//   X = -1/2 rho S C_Da u |u|
//   Y = -1/2 rho S C_L |u| v_l,  v_l = v + x_l r,  x_l = -sign(u) center_aft
//
// and likewise in the vertical plane. The law is bounded, the same for both directions of the flow, and
// smooth where u changes its sign, since |u| x_l = -center_aft u.
inline BodyForce body_lift_force(const BodyLift& b, double density, const BodyVelocity& nu_r) {
  const double u = nu_r.u, v = nu_r.v, w = nu_r.w, q = nu_r.q, r = nu_r.r, x = b.center_aft_m;
  const double scale = -0.5 * density * b.reference_area_m2, lift = scale * b.lift_slope_per_rad;
  // Products of |u| (v + x_l r) and, for the moment, of x_l times that: x_l |u| = -x u, x_l^2 = x^2.
  const double speed = std::abs(u);
  return {scale * b.axial_drag * speed * u,         lift * (speed * v - x * u * r),
          lift * (speed * w + x * u * q),           0,
          -lift * (-x * u * w - x * x * speed * q), lift * (-x * u * v + x * x * speed * r)};
}

// Returns the sums over the strips with CrossFlowPlanes::kSway, without their common factor.
BodyForce cross_flow_in_sway(const CrossFlow& cross_flow, const BodyVelocity& nu_r);

// Returns the sums over the strips with CrossFlowPlanes::kBoth. Pairs are (along y, along z).
inline BodyForce cross_flow_in_both(const CrossFlow& c, const BodyVelocity& nu_r) {
  using Pair = Eigen::Array2d;
  const Pair at_co(nu_r.v, nu_r.w), per_metre(nu_r.r, -nu_r.q);
  Pair force(0, 0), moment(0, 0);
  for (int i = 0; i < c.strips; ++i) {
    const double x = (i - 0.5 * (c.strips - 1)) * c.strip_length_m;
    const Pair flow = at_co + x * per_metre;
    const double speed = std::sqrt(flow.square().sum());
    force += speed * flow;
    moment += x * speed * flow;
  }
  return {0, force[0], force[1], 0, -moment[1], moment[0]};
}

// Cross-flow drag by strip theory (eq. 6.91, 6.92): each strip at x meets the cross-flow (v + x r, w - x q),
// and its drag is proportional to the magnitude times the vector of that flow. With CrossFlowPlanes::kSway
// the cross-flow is v + x r alone.
//
//   (Y, Z) = -1/2 rho D C_d sum |f| f dx,  f = (v + x r, w - x q)
inline BodyForce cross_flow_force(const CrossFlow& c, double density, double diameter_m,
                                  const BodyVelocity& nu_r) {
  const double scale = -0.5 * density * diameter_m * c.drag_coefficient * c.strip_length_m;
  return scale *
         (c.planes == CrossFlowPlanes::kSway ? cross_flow_in_sway(c, nu_r) : cross_flow_in_both(c, nu_r));
}

}  // namespace halocline::vehicle_sim
