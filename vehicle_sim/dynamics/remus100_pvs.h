// SPDX-License-Identifier: BSD-3-Clause
// The vehicle `remus100-pvs`: a torpedo-shaped AUV of 1.6 m and 31 kg, as one published program models it.
//
// Source: T. I. Fossen, Python Vehicle Simulator, class remus100 (2021 and later), after Fossen 2021
// (Handbook, 2nd ed., chapters 8 and 9) and, for propeller and fins, Allen, Vorus and Prestero 2000 (OCEANS).
// Added masses: Lamb's factors of the prolate spheroid. It is one of several published "REMUS 100"s, which
// turn in circles of 7 to 25 m at the same rudder; hence the suffix. Range: ahead at 0.5 to 2.6 m/s, fins
// within 15 degrees. Accuracy against that program's equations: rounding. Known artefacts, kept because the
// name promises that model:
// - the lift grows with atan2(w_r, u_r), so moving astern it is that of pi radians, and w_r = 0 lies on a
// branch cut.
//   Here a zero of either sign counts as +0, which takes the branch +pi;
// - Munk moments are absent, heave and pitch have no cross-flow drag, heave damping does not fall with speed;
// - the fins see the velocity of CO, not their own, and no propeller race;
// - with CurrentTreatment::kUpstream the current ignores roll and pitch and the propeller sees ground speed;
// - the cross-flow strips cover 21/20 of the hull.
#pragma once

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

inline constexpr const char* kRemus100PvsName = "remus100-pvs";

// The parameters, to be changed before a Model is made from them (to a heavier or lighter one).
// `treatment`: kUpstream is the published one, kGalilean handles the current exactly.
ModelParameters remus100_pvs_parameters(CurrentTreatment treatment);

// Added masses of a prolate spheroid over those of the water it displaces: along the axis, across it, and in
// rotation about a cross axis over the displaced water's moment of inertia (Lamb 1932, sections 114 and 115,
// as given in Fossen 2021, section 8.1.5).
struct LambFactors {
  double axial = 0, transverse = 0, rotational = 0;
};

// Semi-axes in metres, 0 < transverse < axial.
LambFactors lamb_factors(double semi_axis_axial_m, double semi_axis_transverse_m);

}  // namespace halocline::vehicle_sim
