// SPDX-License-Identifier: BSD-3-Clause
// Clocks of a scenario's vehicles, read from sections that belong to other programs: [vehicle.clock], and the
// keys of [scenario] and [channel_server] on which the readings depend.
#pragma once

#include <cstdint>
#include <vector>

#include "bus/config/config.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct ClockSetConfig {
  std::vector<channel_server::ClockOf> clocks;               // clocks of the vehicles that have their own
  std::uint64_t seed = 1;                                    // seed of the scenario
  SimDuration fix_lag = SimDuration::from_milliseconds(50);  // delay after which a GPS fix sets a clock
};

// Reads the sections. It writes nothing, because every key belongs to another program.
void visit(bus::ConfigVisitor& v, ClockSetConfig& config);

}  // namespace halocline::clients
