// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/torpedo.h"

#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

// Prestero 2001, after Hoerner 1965: of a low fin of the vehicle's planform; of a cylinder across the flow;
// of a slender body on its diameter squared, which acts at 0.65 of the length from the leading end.
constexpr double kFinLiftSlope = 3.12;  // 1/rad
constexpr double kSectionDrag = 1.1;
constexpr double kBodyLiftOnDiameter = 1.2;  // 1/rad
constexpr double kLiftCenterFromNose = 0.65;
constexpr double kFinNormalDrag = 1.2;    // of a flat plate across the flow, Hoerner 1965
constexpr double kFinsFromStern = 0.036;  // m, Prestero 2001: the fin posts before the hull's end
constexpr int kStrips = 10;

}  // namespace

ModelParameters torpedo_parameters() {
  ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kGalilean);
  const double length = p.hull.length_m, diameter = p.hull.diameter_m;
  p.name = kTorpedoName;
  p.added_mass_coriolis = AddedMassCoriolis::kFull;
  p.damping.decay_s_per_m[2] = p.damping.decay_s_per_m[1];
  // The slope on the diameter squared, C_L,d d^2 = C_L S; its place from the leading end, behind the middle.
  p.body_lift = {
      .reference_area_m2 = p.lift_drag.reference_area_m2,
      .axial_drag = p.lift_drag.zero_lift_drag,
      .lift_slope_per_rad = kBodyLiftOnDiameter * diameter * diameter / p.lift_drag.reference_area_m2,
      .center_aft_m = (kLiftCenterFromNose - 0.5) * length};
  p.lift_drag = {};
  p.cross_flow = {kSectionDrag, length / kStrips, kStrips, CrossFlowPlanes::kBoth};
  for (FinPair* fins : {&p.rudder, &p.stern_planes}) {
    fins->law = FinLaw::kLocalFlow;
    fins->lift_slope_per_rad = kFinLiftSlope;
    fins->normal_drag = kFinNormalDrag;
    fins->x_m = -length / 2 + kFinsFromStern;
  }
  p.propeller.inflow = ThrusterInflow::kAxial;
  return p;
}

}  // namespace halocline::vehicle_sim
