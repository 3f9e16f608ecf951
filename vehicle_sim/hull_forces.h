// Forces of the water on a hull that moves through it, one function an effect; all in the body frame about
// CO.
//
// Each takes the velocity relative to the water, nu_r = (u, v, w, p, q, r) in m/s and rad/s, and returns a
// force and moment in N and N m that stands on the right of M nu_dot = ... (signs as there). Sources at each
// function; equation numbers are those of Fossen 2021. None does positive work on a hull in water at rest.
#pragma once

#include "vehicle_sim/vehicle_model.h"

namespace halocline::vehicle_sim {

// -C nu by Kirchhoff's equations, (P, H) = mass nu (eq. 3.46): -(w x P, w x H + v x P). Does no work: nu . C
// nu = 0. `mass` symmetric, about CO.
Vec6 coriolis_force(const Mat6& mass, const Vec6& nu);

// The part of coriolis_force in which translation acts through roll alone (AddedMassCoriolis::kRollOnly): the
// elements 15, 16, 35, 26 (rows and columns from 1) of C and their mirror images are taken as zero. Does no
// work.
Vec6 roll_only_coriolis_force(const Mat6& mass, const Vec6& nu);

// -D nu_r with the diagonal D of `damping`; `relative_speed_mps` = |(u, v, w)|.
Vec6 damping_force(const Damping& damping, const Vec6& nu_r, double relative_speed_mps);

// Lift across and drag along the flow in the x-z plane (eq. 8.23 to 8.26); no moment. The lift law is linear
// in alpha = atan2(w, u) in [-pi, pi]; a w of -0 counts as +0. `density` in kg/m^3.
Vec6 lift_drag_force(const LiftDrag& lift_drag, double density, const Vec6& nu_r, double relative_speed_mps);

// X = -1/2 rho S C_Da u |u|, and across the hull -1/2 rho S C_L |u| v_l with v_l the velocity across it at the place of
// the lift, center_aft behind the middle as the hull moves (x_l = -sign(u) center_aft): the sin(alpha) cos(alpha) law of
// a slender body (Allen and Perkins 1951, NACA 1048; Hoerner 1965, chapter 19, for coefficient and place), which is
// bounded, and the same for both directions of the flow. Smooth where u changes its sign: |u| x_l = -center_aft u.
Vec6 body_lift_force(const BodyLift& body_lift, double density, const Vec6& nu_r);

// Force and moment of strips that each meet the cross-flow (v + x r, w - x q) with its own size; with
// CrossFlowPlanes::kSway of v + x r alone (eq. 6.91, 6.92).
Vec6 cross_flow_force(const CrossFlow& cross_flow, double density, double diameter_m, const Vec6& nu_r);

}  // namespace halocline::vehicle_sim
