// SPDX-License-Identifier: BSD-3-Clause
// The clocks of a scenario's vehicles, read from sections that other programs write: [vehicle.clock], and
// what decides their readings in [scenario] and [channel_server].
#pragma once

#include <cstdint>
#include <vector>

#include "bus/config/config.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct ClockSetConfig {
  std::vector<channel_server::ClockOf> clocks;               // of the vehicles that have one of their own
  std::uint64_t seed = 1;                                    // of the scenario
  SimDuration fix_lag = SimDuration::from_milliseconds(50);  // after which a GPS fix sets a clock
};

// Reads; writes nothing, as every key belongs to another program.
void visit(bus::ConfigVisitor& v, ClockSetConfig& config);

}  // namespace halocline::clients
