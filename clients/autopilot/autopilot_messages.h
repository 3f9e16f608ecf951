// Messages of the bus to the values of the control laws, and back.
#pragma once

#include "bus/messages.h"
#include "clients/autopilot/control_laws.h"
#include "clients/autopilot/hover_laws.h"

namespace halocline::clients {

Vec3 position_of(const vehicle_state_t& state);

// Attitude and rates from the state. The speed is the forward component over ground: SENSORS tells
// that through the water.
Measured to_measured(const vehicle_state_t& state);

HoverMeasured to_hover_measured(const vehicle_state_t& state);

// Time and numbering are the caller's.
vehicle_command_t to_message(const ActuatorCommand& command);
vehicle_command_t to_message(const std::array<double, 4>& thruster_rpm);

}  // namespace halocline::clients
