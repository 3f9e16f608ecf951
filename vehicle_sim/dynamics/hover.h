// SPDX-License-Identifier: BSD-3-Clause
// The vehicle `hover`: four thrusters and no fins; it can stand still in a current.
//
// Hull: a neutrally buoyant prolate spheroid of 1.4 m and 0.35 m (92 kg), added masses by Lamb's factors,
// Munk moments, body lift and cross-flow as in torpedo.h. Thrusters, in the order of
// ActuatorValues::thruster_hz and of vehicle_command_t's thruster_rpm: 1 port and 2 starboard push ahead
// (both: surge, their difference: yaw), 3 bow and 4 stern push down (both: heave, their difference: pitch).
// There is no thruster across: it holds station by turning its bow against the drift
// (clients/autopilot/hover_laws.h). Each thruster pushes 51 N ahead and 40 N astern at 60 turns a second,
// after the published bollard figures of a common 76 mm thruster at 16 V (Blue Robotics T200, 5.25 and 4.1
// kilogram-force). Chosen, not measured: hull form, drag, fall of thrust with speed. Range: 0 to 2 m/s, any
// attitude.
#pragma once

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

inline constexpr const char* kHoverName = "hover";

ModelParameters hover_parameters();

}  // namespace halocline::vehicle_sim
