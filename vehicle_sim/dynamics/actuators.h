// SPDX-License-Identifier: BSD-3-Clause
// Parameters of a vehicle's actuators: fins, propeller and thrusters, buoyancy engine, moving mass, drop
// weight.
//
// They are part of ModelParameters (vehicle_model.h), with its frame and units: body frame, positions from
// CO, SI units and radians. Their forces are in actuator_forces.h, those of ballast in equations_of_motion.h.
#pragma once

#include <cstddef>

#include "core/frames.h"

namespace halocline::vehicle_sim {

enum class FinLaw {
  kDeflection,  // force proportional to the deflection at any flow angle (`remus100-pvs`)
  kLocalFlow,   // force by the local flow angle, including the velocity of the fin itself
};

struct FinPair {
  double area_m2 = 0;             // area of the pair, 0 or above
  double lift_slope_per_rad = 0;  // 0 or above
  double x_m = 0;                 // position on the body's x axis, negative aft
  FinLaw law = FinLaw::kDeflection;
  double normal_drag = 0;  // kLocalFlow: drag coefficient of the flow normal to the fin, 0 or above
};

enum class ThrusterInflow {
  // V_a = advance_speed_ratio |v|; astern, K_T and K_Q keep their values at J = 0 (as published).
  kSpeed,
  // V_a = advance_speed_ratio times the water's velocity along the shaft at the thruster, of either sign.
  kAxial,
};

// Fixed-pitch propeller or thruster. K_T and K_Q are linear in the advance number J = V_a / (|n| D), from
// their values at J = 0 to those at advance_max.
struct Thruster {
  Vec3 position_m = Vec3::Zero();  // from CO
  Vec3 direction = Vec3::UnitX();  // direction of the force on the hull at positive speed; unit
  double diameter_m = 0;           // 0 or above; 0: no thruster
  ThrusterInflow inflow = ThrusterInflow::kAxial;
  double advance_speed_ratio = 1;  // V_a over the vehicle's speed, 1 - wake fraction; 0 or above
  double thrust_at_rest = 0;       // K_T at J = 0
  double thrust_at_max = 0;        // K_T at J = advance_max
  double torque_at_rest = 0;       // K_Q at J = 0
  double torque_at_max = 0;        // K_Q at J = advance_max
  double advance_max = 1;          // above 0
  double thrust_share = 1;         // share of the thrust that reaches the hull, 1 - thrust deduction
  double torque_share = 1;         // share of the shaft torque that reaches the hull
  double astern_ratio = 1;         // K_T at rest astern / K_T at rest ahead, 0 to 1
  double lag_s = 1;                // first-order lag towards the command; above 0
  double max_hz = 0;               // maximum speed either way; 0 or above
};

inline constexpr std::size_t kMaxThrusters = 4;  // besides the propeller

// First-order lag of the fins towards the command, which is first limited to max_angle_rad.
struct FinServo {
  double lag_s = 0.1;        // above 0
  double max_angle_rad = 0;  // 0 to pi/2
};

// Actuator with a first-order lag towards its command, a maximum rate and a limit.
struct SlowActuator {
  double limit = 0;  // maximum magnitude, 0 or above
  double rate = 0;   // maximum rate, per second, 0 or above
  double lag_s = 1;  // above 0
};

// Buoyancy engine: a bladder that oil is pumped into and out of, which changes the volume at constant mass.
// Volumes in m^3, relative to neutral.
struct BuoyancyEngine {
  SlowActuator pump;  // limit 0: no buoyancy engine
  Vec3 position_m = Vec3::Zero();
};

// Part of the body that is driven along its x axis. Mass and inertia of the body hold with it in its middle
// position. Positions in metres, positive forward.
struct MovingMass {
  double mass_kg = 0;  // 0 or above; 0: no moving mass
  SlowActuator drive;
};

// Part of the body that can be dropped. Mass, inertia and buoyancy of the body include it.
struct DropWeight {
  double mass_kg = 0;     // 0 or above; 0: no drop weight
  double buoyancy_n = 0;  // buoyancy of the weight itself, 0 or above
  Vec3 position_m = Vec3::Zero();
};

}  // namespace halocline::vehicle_sim
