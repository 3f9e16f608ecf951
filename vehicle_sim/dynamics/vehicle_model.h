// SPDX-License-Identifier: BSD-3-Clause
// Description of an underwater vehicle: all parameters of its equations of motion, fixed at construction.
//
// Model: rigid body with added mass in six degrees of freedom (Fossen, Handbook of Marine Craft Hydrodynamics
// and Motion Control, 2nd ed. 2021, chapters 3, 6 and 8):
//
//   M nu_r_dot = tau_actuators + tau_hull - C(nu_r) nu_r - D(nu_r) nu_r - g(eta),  nu_r = nu - nu_c
//
// Frame: body, origin CO at the hull's centre, x forward, y starboard, z down. 6-vectors are (surge, sway,
// heave; roll, pitch, yaw). All in SI units and radians; propeller speed in revolutions per second (Hz). An
// effect whose area or coefficient is 0 is absent. docs/vehicles.md describes each effect and the models
// built from them. Left out: the change of added mass near the surface, the fins' own added mass, lateral
// forces of the propeller, its slipstream over the fins, the effect of a moving mass on the mass matrix.
// Threads: a Model never changes, so any number of threads may read it.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "vehicle_sim/dynamics/actuators.h"

namespace halocline::vehicle_sim {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat3 = Eigen::Matrix3d;

// Outer shape of the hull, for contact and for buoyancy at the surface: a spheroid about the body's x axis.
struct HullShape {
  double length_m = 0;    // above 0
  double diameter_m = 0;  // above 0, at most the length
};

// Wall-sided hull that pierces the surface, in addition to the body's own buoyancy: an upright elliptic
// cylinder.
struct Float {
  Vec3 bottom_m = Vec3::Zero();  // centre of its bottom, from CO
  double length_m = 0;           // along x, above 0
  double beam_m = 0;             // along y, above 0
  double height_m = 0;           // from the bottom up, above 0
};

inline constexpr std::size_t kMaxFloats = 16;

// Sea surface on which a hull floats.
enum class SeaSurface {
  kStill,  // level: waves act below it by their orbital motion alone
  kWaves,  // surface of the waves
};

// Terms of the added-mass Coriolis matrix that are applied.
enum class AddedMassCoriolis {
  kFull,      // all, with Munk moments
  kRollOnly,  // coupling through roll rate, and the rotational block (as in `remus100-pvs`)
};

enum class CurrentTreatment {
  // The current is rotated by yaw only, and the propeller sees the speed over ground (as published with
  // `remus100-pvs`).
  kUpstream,
  // Exact: the current is rotated by the whole attitude, and the propeller sees the relative speed. A steady
  // current v_c then shifts every path by v_c t and changes nothing else.
  kGalilean,
};

// Linear damping of each degree of freedom k: D_k = linear_k exp(-decay_k |v_r|).
struct Damping {
  Vec6 linear = Vec6::Zero();         // N s/m (first three), N m s (last three); 0 or above
  Vec6 decay_s_per_m = Vec6::Zero();  // 0 or above; 0 leaves the term constant
};

enum class LiftLaw {
  kAngle,    // linear in alpha, as published with `remus100-pvs`: discontinuous in reverse flow
  kBounded,  // sin(alpha) cos(alpha) and sin(alpha)^2 at x_m: equal at small angles, always smooth
};

// Lift and drag of the hull and its wings in the x-z plane, by the angle of attack alpha = atan2(w_r, u_r):
//
//   C_L = lift_slope alpha
//   C_D = zero_lift_drag + C_L^2 / (pi oswald aspect_ratio)
struct LiftDrag {
  double reference_area_m2 = 0;   // 0 or above
  double zero_lift_drag = 0;      // C_D0, 0 or above
  double lift_slope_per_rad = 0;  // 0 or above
  double aspect_ratio = 1;        // above 0
  double oswald_efficiency = 1;   // e, above 0 and at most 1
  LiftLaw law = LiftLaw::kAngle;
  double x_m = 0;  // kBounded: point of action on the body's x axis, negative aft
  // kBounded: C_D at 90 degrees, above zero_lift_drag; 0: that of the induced drag, k sin(alpha)^2.
  double broadside_drag = 0;
};

// Drag along the hull and lift across it, bounded and smooth at every angle of attack: see body_lift_force.
struct BodyLift {
  double reference_area_m2 = 0;   // 0 or above
  double axial_drag = 0;          // coefficient of u |u|, 0 or above
  double lift_slope_per_rad = 0;  // coefficient of sin(alpha) cos(alpha), 0 or above
  double center_aft_m = 0;        // position of the lift behind the middle, as the hull moves; 0 or above
};

enum class CrossFlowPlanes {
  kSway,  // sway and yaw alone (`remus100-pvs`)
  kBoth,  // sway and heave together, yaw and pitch
};

// Cross-flow drag of a cylinder cut into strips along x (strip theory, Hoerner 1965).
struct CrossFlow {
  double drag_coefficient = 0;  // drag coefficient of the cylinder's section, 0 or above
  double strip_length_m = 0;    // 0 or above
  int strips = 0;               // 0 or above; their centres are symmetric about CO, strip_length_m apart
  CrossFlowPlanes planes = CrossFlowPlanes::kSway;
};

// Parameters of a Model, in a plain struct that a file can fill.
struct ModelParameters {
  std::string name;
  double water_density_kg_m3 = 1026;
  double gravity_m_s2 = 9.81;
  HullShape hull;
  SeaSurface sea_surface = SeaSurface::kStill;
  double mass_kg = 0;                        // dry mass, above 0
  double buoyancy_n = 0;                     // buoyancy of the submerged hull without its floats, 0 or above
  Vec3 center_of_gravity_m = Vec3::Zero();   // from CO
  Vec3 center_of_buoyancy_m = Vec3::Zero();  // from CO
  Vec3 leak_offset_m = Vec3::Zero();         // collecting point of leak water, from the centre of gravity
  Vec3 transducer_m = Vec3::Zero();          // modem transducer, from CO; STATE gives its position
  Mat3 inertia_kg_m2 = Mat3::Identity();     // about the centre of gravity; symmetric, positive
  Mat6 added_mass = Mat6::Zero();            // about CO; symmetric, no negative element on the diagonal
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
  std::vector<Thruster> thrusters;  // at most kMaxThrusters
  std::vector<Float> floats;        // at most kMaxFloats; they replace the spheroid at the surface
  BuoyancyEngine buoyancy_engine;
  MovingMass moving_mass;
  DropWeight drop_weight;
};

// Model ready for use: the checked parameters and the matrices computed from them.
class Model {
 public:
  // Throws InvalidArgument when a parameter is out of its range, or when M is not positive definite.
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

// Returns the parameters after the release of the drop weight; unchanged for a vehicle without one.
ModelParameters without_weight(ModelParameters parameters);

// Returns the matrix S(a) with S(a) b = a x b.
Mat3 skew(const Vec3& a);

// Returns the rigid-body mass matrix about CO (Fossen 2021, eq. 3.35), r the centre of gravity from CO,
// metres:
//
//   M_RB = H^T diag(m I, I_g) H,  H = [I, S(r)^T; 0, I]
Mat6 rigid_body_mass_matrix(double mass_kg, const Mat3& inertia_kg_m2, const Vec3& center_of_gravity_m);

}  // namespace halocline::vehicle_sim
