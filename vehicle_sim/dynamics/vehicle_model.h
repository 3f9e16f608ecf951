// SPDX-License-Identifier: BSD-3-Clause
// The description of an underwater vehicle: every number its equations of motion need, fixed once made.
//
// Model: rigid body with added mass in six degrees of freedom (Fossen, Handbook of Marine Craft Hydrodynamics
// and Motion Control, 2nd ed. 2021, chapters 3, 6 and 8):
//   M nu_dot = tau_actuators + tau_hull - C(nu_r) nu_r - D(nu_r) nu_r - g(eta),  nu_r = nu - nu_c.
// Frame: body, origin CO at the hull's centre, x forward, y starboard, z down. 6-vectors are (surge, sway,
// heave; roll, pitch, yaw). All SI and radians; propeller speed in revolutions per second (Hz). An effect
// whose area or coefficient is 0 is absent. docs/vehicles.md describes each effect and the models made of
// them. Left out: shift of added mass near the surface, fins' own added mass, propeller lateral forces, the
// propeller's race over the fins, what a moving mass does to the mass matrix. Threads: a Model never changes;
// any number of threads may read one.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "vehicle_sim/dynamics/actuators.h"

namespace halocline::vehicle_sim {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat3 = Eigen::Matrix3d;

// The outer shape of the hull, for contact and for buoyancy at the surface: a spheroid about the body's x
// axis.
struct HullShape {
  double length_m = 0;    // above 0
  double diameter_m = 0;  // above 0, at most the length
};

// A wall-sided hull that pierces the surface, besides what the body's buoyancy tells of: an upright elliptic
// cylinder.
struct Float {
  Vec3 bottom_m = Vec3::Zero();  // middle of its bottom, from CO
  double length_m = 0;           // along x, above 0
  double beam_m = 0;             // across, above 0
  double height_m = 0;           // from the bottom up, above 0
};

inline constexpr std::size_t kMaxFloats = 16;

// The surface that a hull floats on.
enum class SeaSurface {
  kStill,  // level: waves act under it by their orbital motion alone
  kWaves,  // that of the waves
};

// Which terms of the added-mass Coriolis matrix act.
enum class AddedMassCoriolis {
  kFull,      // all of it: with Munk moments
  kRollOnly,  // only coupling through roll rate and the rotational block (what `remus100-pvs` keeps)
};

// How water that moves enters the equations.
enum class CurrentTreatment {
  // As published with `remus100-pvs`: the current is turned by yaw only, and the propeller sees the ground
  // speed.
  kUpstream,
  // Exact: the current is turned by the whole attitude, the propeller sees the relative speed. Then a steady
  // current v_c moves every path by v_c t and changes nothing else.
  kGalilean,
};

// Linear damping, each degree of freedom k: D_k = damping_k exp(-decay_k |v_r|).
struct Damping {
  Vec6 linear = Vec6::Zero();         // N s/m (first three), N m s (last three); 0 or above
  Vec6 decay_s_per_m = Vec6::Zero();  // 0 or above; 0 leaves the term constant
};

enum class LiftLaw {
  kAngle,    // of alpha itself, as published with `remus100-pvs`: jumps in reverse flow
  kBounded,  // of sin(alpha) cos(alpha) and sin(alpha)^2 in the flow at x_m: the same at small angles, smooth
             // at all
};

// Lift and drag of the hull and its wings in the x-z plane, of the angle of attack alpha = atan2(w_r, u_r):
// C_L = lift_slope alpha, C_D = zero_lift_drag + C_L^2 / (pi oswald aspect_ratio).
struct LiftDrag {
  double reference_area_m2 = 0;   // 0 or above
  double zero_lift_drag = 0;      // C_D0, 0 or above
  double lift_slope_per_rad = 0;  // 0 or above
  double aspect_ratio = 1;        // above 0
  double oswald_efficiency = 1;   // e, above 0 and at most 1
  LiftLaw law = LiftLaw::kAngle;
  double x_m = 0;  // kBounded: where the force acts on the body's axis, negative aft
  double broadside_drag =
      0;  // kBounded: at 90 degrees, above zero_lift_drag; 0: that of the induced drag's sin(alpha)^2
};

// Drag along the hull and lift across it, bounded and smooth at every angle of attack: see body_lift_force.
struct BodyLift {
  double reference_area_m2 = 0;   // 0 or above
  double axial_drag = 0;          // of u |u|, 0 or above
  double lift_slope_per_rad = 0;  // of sin(alpha) cos(alpha), 0 or above
  double center_aft_m = 0;        // how far behind the hull's middle, as it moves, the lift acts; 0 or above
};

enum class CrossFlowPlanes {
  kSway,  // sway and yaw alone (`remus100-pvs`)
  kBoth,  // sway and heave together, yaw and pitch
};

// Drag of the cross-flow on a cylinder cut into strips along x (strip theory, Hoerner 1965).
struct CrossFlow {
  double drag_coefficient = 0;  // of the cylinder's section, 0 or above
  double strip_length_m = 0;    // 0 or above
  int strips = 0;               // 0 or above; centres lie symmetric about CO, strip_length_m apart
  CrossFlowPlanes planes = CrossFlowPlanes::kSway;
};

// What a model is made from. A plain struct, so that a file may fill it.
struct ModelParameters {
  std::string name;
  double water_density_kg_m3 = 1026;
  double gravity_m_s2 = 9.81;
  HullShape hull;
  SeaSurface sea_surface = SeaSurface::kStill;
  double mass_kg = 0;                        // dry mass, above 0
  double buoyancy_n = 0;                     // of the whole hull under water without its floats, 0 or above
  Vec3 center_of_gravity_m = Vec3::Zero();   // from CO
  Vec3 center_of_buoyancy_m = Vec3::Zero();  // from CO
  Vec3 leak_offset_m = Vec3::Zero();  // of the place where a leak's water gathers from the centre of gravity
  Vec3 transducer_m = Vec3::Zero();   // of the modem, from CO: STATE gives its place
  Mat3 inertia_kg_m2 = Mat3::Identity();  // about the centre of gravity; symmetric, positive
  Mat6 added_mass = Mat6::Zero();         // about CO; symmetric, none negative
  AddedMassCoriolis added_mass_coriolis = AddedMassCoriolis::kFull;
  CurrentTreatment current_treatment = CurrentTreatment::kGalilean;
  Damping damping;
  LiftDrag lift_drag;
  BodyLift body_lift;
  CrossFlow cross_flow;
  FinPair rudder;
  FinPair stern_planes;
  FinServo fin_servo;
  Thruster propeller;
  std::vector<Thruster> thrusters;  // kMaxThrusters at most
  std::vector<Float> floats;  // kMaxFloats at most; with any the spheroid displaces no water at the surface
  BuoyancyEngine buoyancy_engine;
  MovingMass moving_mass;
  DropWeight drop_weight;
};

// A model ready for use: the parameters, checked, and the matrices made from them.
class Model {
 public:
  // Throws InvalidArgument where a parameter lies outside of its range, or where M is not positive definite.
  explicit Model(ModelParameters parameters);

  const ModelParameters& parameters() const { return parameters_; }
  const std::string& name() const { return parameters_.name; }
  double weight_n() const { return parameters_.mass_kg * parameters_.gravity_m_s2; }
  const Mat6& rigid_body_mass() const { return rigid_body_mass_; }  // M_RB about CO
  const Mat6& mass() const { return mass_; }                        // M = M_RB + M_A about CO
  const Mat6& inverse_mass() const { return inverse_mass_; }        // M^-1

 private:
  ModelParameters parameters_;
  Mat6 rigid_body_mass_, mass_, inverse_mass_;
};

// The vehicle once its weight is gone. A vehicle without one stays as it is.
ModelParameters without_weight(ModelParameters parameters);

// The matrix S(a) with S(a) b = a x b.
Mat3 skew(const Vec3& a);

// M_RB about CO = H' diag(m I, I_g) H with H = [I, S(r)'; 0, I] (Fossen 2021, eq. 3.35); r = CG from CO,
// metres.
Mat6 rigid_body_mass_matrix(double mass_kg, const Mat3& inertia_kg_m2, const Vec3& center_of_gravity_m);

}  // namespace halocline::vehicle_sim
