// SPDX-License-Identifier: BSD-3-Clause
// The scenario as SCENARIO: what a log needs to explain itself, from what the server was started with.
#pragma once

#include <cstddef>
#include <vector>

#include "bus/messages.h"
#include "bus/runtime/scenario.h"
#include "channel_server/vehicles/vehicle_registry.h"

namespace halocline::channel_server {

// Of one message: 150 bytes a vehicle, and the lines. A line that is longer has a message of its own.
inline constexpr std::size_t kMaxVehiclesOfPart = 200;
inline constexpr std::size_t kMaxLineBytesOfPart = 24'000;

// The parts, in order. Time, session and sequence are the publisher's to fill in.
std::vector<scenario_info_t> to_messages(const bus::Scenario& scenario, const ConfiguredModems& modems);

}  // namespace halocline::channel_server
