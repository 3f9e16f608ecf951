// SPDX-License-Identifier: BSD-3-Clause
// What a vehicle moves by, as numbers: fins, propeller and thrusters, buoyancy engine, moving mass, drop
// weight.
//
// Part of ModelParameters (vehicle_model.h), with its frame and units: body, from CO, SI and radians. The
// forces: actuator_forces.h, and of ballast equations_of_motion.h.
#pragma once

#include <cstddef>

#include "core/frames.h"

namespace halocline::vehicle_sim {

enum class FinLaw {
  kDeflection,  // force proportional to the deflection, whatever the flow's angle (`remus100-pvs`)
  kLocalFlow,   // force of the flow's angle to the deflected fin, with the velocity of the fin itself
};

// One pair of fins.
struct FinPair {
  double area_m2 = 0;             // of the pair, 0 or above
  double lift_slope_per_rad = 0;  // 0 or above
  double x_m = 0;                 // place on the body's axis, negative aft
  FinLaw law = FinLaw::kDeflection;
  double normal_drag = 0;  // kLocalFlow: of the flow across the fin, 0 or above
};

enum class ThrusterInflow {
  // As published: V_a = advance_speed_ratio |v|, and astern K_T and K_Q stay at their values for J = 0.
  kSpeed,
  // V_a = advance_speed_ratio times the water's velocity along the shaft at the thruster, of either sign.
  kAxial,
};

// A fixed-pitch propeller or thruster; K_T and K_Q fall linearly with the advance number J = V_a / (|n| D)
// from their value at J = 0 to that at advance_max.
struct Thruster {
  Vec3 position_m = Vec3::Zero();  // from CO
  Vec3 direction = Vec3::UnitX();  // of the force on the hull at positive speed; unit
  double diameter_m = 0;           // 0 or above; 0: there is none
  ThrusterInflow inflow = ThrusterInflow::kAxial;
  double advance_speed_ratio = 1;  // V_a over the vehicle's speed, 1 - wake fraction; 0 or above
  double thrust_at_rest = 0;       // K_T at J = 0
  double thrust_at_max = 0;        // K_T at J = advance_max
  double torque_at_rest = 0;       // K_Q at J = 0
  double torque_at_max = 0;        // K_Q at J = advance_max
  double advance_max = 1;          // above 0
  double thrust_share = 1;         // 1 - thrust deduction: what reaches the hull
  double torque_share = 1;         // of the shaft torque: what reaches the hull
  double astern_ratio = 1;         // K_T at rest astern over that ahead; 0 to 1
  double lag_s = 1;                // of the first-order lag towards the command; above 0
  double max_hz = 0;               // greatest speed either way; 0 or above
};

inline constexpr std::size_t kMaxThrusters = 4;  // besides the propeller

// First-order lag of the fins towards the command, which is first held to the limit.
struct FinServo {
  double lag_s = 0.1;        // above 0
  double max_angle_rad = 0;  // 0 to pi/2
};

// What moves to its command by a first-order lag, no faster than its rate, and no further than its limit.
struct SlowActuator {
  double limit = 0;  // either way, 0 or above
  double rate = 0;   // a second, 0 or above
  double lag_s = 1;  // above 0
};

// A bladder that oil is pumped in and out of: changes the volume, at constant mass. Volumes in m^3, beyond
// neutral.
struct BuoyancyEngine {
  SlowActuator pump;  // limit 0: there is none
  Vec3 position_m = Vec3::Zero();
};

// A part of the body that is driven along its x axis; the body's numbers hold with it in its middle. Places
// in metres, positive forward.
struct MovingMass {
  double mass_kg = 0;  // 0 or above; 0: there is none
  SlowActuator drive;
};

// A part of the body that can be dropped; the body's numbers hold with it.
struct DropWeight {
  double mass_kg = 0;     // 0 or above; 0: there is none
  double buoyancy_n = 0;  // its own, 0 or above
  Vec3 position_m = Vec3::Zero();
};

}  // namespace halocline::vehicle_sim
