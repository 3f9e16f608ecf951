// SPDX-License-Identifier: BSD-3-Clause
// The simulation output of a run, apart from how many programs made it: for comparing runs whose channel
// server or vehicle simulator was split (channel_server/vehicles/shard.h, vehicle_sim/vehicle_block.h) with
// runs whose was not.
//
// Left out are the messages between programs: STATUS, HEARTBEAT, REPAIR_REQUEST, REPAIR,
// RAY_QUERY, RAY_REPLY, TERRAIN_QUERY, TERRAIN_REPLY, MODEM_REPLY, FOUND_PATHS, and what is on channels that
// are none of ours. The messages of a channel server (SCENARIO, ENVIRONMENT, LINKS, RECEIPT, RECEIVE,
// MODEM_EVENT, MODEM_ENERGY, OUTCOME, LINK_REPLY) are written without session and sequence, which depend on
// the number of servers, those of a vehicle simulator (STATE, SENSORS, DVL, GPS, SONAR, USBL, BATTERY, FAULT)
// without session. Messages of one stamp are put in order by channel and bytes, because those that share the
// work publish one after the other. All else stays as it is, byte for byte: two runs of the same output write
// the same file.
#pragma once

#include <cstdint>
#include <string>

#include "bus/logs/log_reader.h"

namespace halocline::clients {

// Writes the output as an LCM log to `path` and returns the number of its events. Stamps must not fall, which
// those of our own logs do not; throws InvalidArgument where they do, for an event of a channel server that
// does not decode, and when `path` cannot be written.
std::int64_t write_simulation_output(LogReader& log, const std::string& path);

}  // namespace halocline::clients
