// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/torpedo.h"

#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

// Coefficients of Prestero 2001, after Hoerner 1965: lift slope of a fin of low aspect ratio with the
// vehicle's planform; drag of a cylinder across the flow; lift slope of a slender body on its diameter
// squared, which acts at 0.65 of the length from the leading end.
constexpr double kFinLiftSlope = 3.12;  // 1/rad
constexpr double kSectionDrag = 1.1;
constexpr double kBodyLiftOnDiameter = 1.2;  // 1/rad
constexpr double kLiftCenterFromNose = 0.65;
constexpr double kFinNormalDrag = 1.2;    // flat plate normal to the flow, Hoerner 1965
constexpr double kFinsFromStern = 0.036;  // m, Prestero 2001: distance of the fin posts from the stern
constexpr int kStrips = 10;

}  // namespace

ModelParameters torpedo_parameters() {
  ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kGalilean);
  const double length = p.hull.length_m, diameter = p.hull.diameter_m;
  p.name = kTorpedoName;
  p.added_mass_coriolis = AddedMassCoriolis::kFull;
  p.damping.decay_s_per_m[2] = p.damping.decay_s_per_m[1];
  // The lift slope refers to the diameter squared: C_L,d d^2 = C_L S. It acts at a fraction of the length
  // from the leading end, behind the middle.
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
