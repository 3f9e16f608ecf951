// SPDX-License-Identifier: BSD-3-Clause
// Conversion to messages and back of vehicles and the water: states, modems, ENVIRONMENT and its changes.
#pragma once

#include <optional>
#include <string>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "bus/messages/messages.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

StampedState to_state(const vehicle_state_t& message);

// Returns the modem of a message. Throws InvalidArgument for a modem that acoustics/modem/modem.h refuses.
VehicleModem to_modem(const modem_config_t& message);
modem_config_t to_message(const VehicleModem& modem, SimTime from);
Listening to_listening(const modem_listen_t& message);

// The contents of ENVIRONMENT besides the water.
struct WaterDescription {
  std::string propagation;                       // "straight", "rays"
  std::optional<acoustics::FluidBottom> bottom;  // with rays
  std::optional<acoustics::SurfaceModel> surface;
};

// Returns the turn rate of the fastest of propeller and thrusters, turns a second.
double turn_rate_hz(const vehicle_sensors_t& sensors);

// Returns the ENVIRONMENT message. The profile is given at the depths of its rows (every second, third, ...
// row when there are more than 2000), or for a formula every 100 m down to 5000 m.
environment_t to_message(const acoustics::Environment& environment, const WaterDescription& description,
                         SimTime from, const std::string& terrain_version);

// Returns the change that a message requests of the environment `before`, whose formula of sound speed stays.
// Throws InvalidArgument when the profile is impossible.
EnvironmentChange to_change(const environment_change_t& message, const acoustics::Environment& before);

}  // namespace halocline::channel_server
