// SPDX-License-Identifier: BSD-3-Clause
// Vehicle model `remus100-pvs`: a torpedo-shaped AUV of 1.6 m and 31 kg, as one published program models it.
//
// Source: T. I. Fossen, Python Vehicle Simulator, class remus100 (2021 and later), after Fossen 2021
// (Handbook, 2nd ed., chapters 8 and 9) and, for propeller and fins, Allen, Vorus and Prestero 2000 (OCEANS).
// Added masses: Lamb's factors of the prolate spheroid. Several published models are called "REMUS 100", with
// turning circles of 7 to 25 m at the same rudder angle; hence the suffix. Range: ahead at 0.5 to 2.6 m/s,
// fins within 15 degrees. Accuracy against that program's equations: rounding. Artefacts of that program are
// kept:
//
// - the lift grows with atan2(w_r, u_r): astern it is that of an angle of pi, and w_r = 0 lies on a branch
//   cut, where a zero of either sign counts as +0 here and takes the branch +pi;
// - Munk moments are absent, heave and pitch have no cross-flow drag, and heave damping does not decrease
//   with speed;
// - the fins see the velocity of CO, not their own, and no slipstream of the propeller;
// - with CurrentTreatment::kUpstream the current ignores roll and pitch, and the propeller sees the speed
//   over ground;
// - the cross-flow strips cover 21/20 of the hull.
#pragma once

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

inline constexpr const char* kRemus100PvsName = "remus100-pvs";

// Returns the parameters, which a caller may change (for a heavier or lighter vehicle) before it makes a
// Model of them. `treatment`: kUpstream is the published one, kGalilean treats the current exactly.
ModelParameters remus100_pvs_parameters(CurrentTreatment treatment);

// Lamb's factors of a prolate spheroid: its added masses along the axis and across it, divided by the mass of
// the displaced water, and its added moment of inertia about a transverse axis, divided by the moment of
// inertia of the displaced water (Lamb 1932, sections 114 and 115, as given in Fossen 2021, section 8.1.5).
struct LambFactors {
  double axial = 0, transverse = 0, rotational = 0;
};

// Requires 0 < transverse < axial semi-axis, in metres; throws InvalidArgument otherwise.
LambFactors lamb_factors(double semi_axis_axial_m, double semi_axis_transverse_m);

}  // namespace halocline::vehicle_sim
