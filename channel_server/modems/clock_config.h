// SPDX-License-Identifier: BSD-3-Clause
// [vehicle.clock] of a scenario: the clock by which a vehicle's modem stamps packets and measures arrivals.
#pragma once

#include "bus/config/config.h"
#include "channel_server/vehicles/vehicle_clocks.h"

namespace halocline::channel_server {

// Visits the keys of [vehicle.clock]: offset, s; drift, ppm in the file; random walk, s/sqrt(s); setting by
// GPS.
void visit_clock(bus::ConfigVisitor& v, ClockSettings& clock);

}  // namespace halocline::channel_server
