// SPDX-License-Identifier: BSD-3-Clause
// Simulation output of a run, independent of the number of programs that made it: for comparing runs whose
// channel server or vehicle simulator was split (channel_server/vehicles/shard.h,
// vehicle_sim/vehicle_block.h) with runs of single ones.
//
// The messages between programs are left out: STATUS, HEARTBEAT, REPAIR_REQUEST, REPAIR, RAY_QUERY,
// RAY_REPLY, TERRAIN_QUERY, TERRAIN_REPLY, MODEM_REPLY, FOUND_PATHS, and everything on channels that are none
// of Halocline's. The messages of a channel server (SCENARIO, ENVIRONMENT, LINKS, RECEIPT, RECEIVE,
// MODEM_EVENT, MODEM_ENERGY, OUTCOME, LINK_REPLY) are written without session and sequence, which depend on
// the number of servers; those of a vehicle simulator (STATE, SENSORS, DVL, GPS, SONAR, USBL, BATTERY, FAULT)
// without session. Messages with the same stamp are sorted by channel and bytes, because programs that share
// the work publish one after the other. Everything else is copied byte for byte: two runs with the same
// output write the same file.
#pragma once

#include <cstdint>
#include <string>

#include "bus/logs/log_reader.h"

namespace halocline::clients {

// Writes the output as an LCM log to `path` and returns the number of its events. Stamps must not decrease,
// which holds for logs of Halocline's own runs. Throws InvalidArgument when they do, when an event of a
// channel server does not decode, and when `path` cannot be written.
std::int64_t write_simulation_output(LogReader& log, const std::string& path);

}  // namespace halocline::clients
