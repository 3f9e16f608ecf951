// What a scenario file says of a modem: [modem], and [vehicle.modem] where it differs.
//
// `profile` sets the numbers of a modem that exists (acoustics/modem/modem_profile.h); every other key then changes one
// of them. A vehicle's table starts from the scenario's modem, or from the profile it names where that is another.
#pragma once

#include "bus/config/config.h"
#include "channel_server/vehicles/modem_schedule.h"

namespace halocline::channel_server {

void visit_modem(bus::ConfigVisitor& v, VehicleModem& modem);

}  // namespace halocline::channel_server
