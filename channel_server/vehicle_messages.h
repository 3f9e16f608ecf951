// States and modems of vehicles, from messages and back.
#pragma once

#include "bus/messages.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"

namespace halocline::channel_server {

StampedState to_state(const vehicle_state_t& message);

// Throws InvalidArgument for a modem that acoustics/modem/modem.h refuses.
VehicleModem to_modem(const modem_config_t& message);
modem_config_t to_message(const VehicleModem& modem, SimTime from);

}  // namespace halocline::channel_server
