// SPDX-License-Identifier: BSD-3-Clause
// Vehicle model `hover`: four thrusters and no fins; it can hold its position in a current.
//
// Hull: a neutrally buoyant prolate spheroid of 1.4 m and 0.35 m (92 kg), with added masses by Lamb's
// factors, and Munk moments, body lift and cross-flow as in torpedo.h. Thrusters, in the order of
// ActuatorValues::thruster_hz and of vehicle_command_t's thruster_rpm:
//
//   1 port, 2 starboard    push ahead: the sum controls surge, the difference yaw
//   3 bow, 4 stern         push down: the sum controls heave, the difference pitch
//
// There is no lateral thruster: the vehicle holds station by turning its bow against the drift
// (clients/onboard/autopilot/hover_laws.h). Each thruster has a thrust of 51 N ahead and 40 N astern at 60
// revolutions per second, after the published bollard figures of a common 76 mm thruster at 16 V (Blue
// Robotics T200, 5.25 and 4.1 kilogram-force). Hull form, drag and the decrease of thrust with speed are
// chosen, not measured. Range: 0 to 2 m/s, any attitude.
#pragma once

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

inline constexpr const char* kHoverName = "hover";

ModelParameters hover_parameters();

}  // namespace halocline::vehicle_sim
