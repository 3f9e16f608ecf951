// SPDX-License-Identifier: BSD-3-Clause
// The SCENARIO messages: the scenario with which the server was started, so that a log explains itself.
#pragma once

#include <cstddef>
#include <vector>

#include "bus/config/scenario.h"
#include "bus/messages/messages.h"
#include "channel_server/vehicles/vehicle_registry.h"

namespace halocline::channel_server {

// Bounds of one message: a vehicle takes 150 bytes, and the lines of the configuration come in addition. A
// line longer than the bound gets a message of its own.
inline constexpr std::size_t kMaxVehiclesOfPart = 200;
inline constexpr std::size_t kMaxLineBytesOfPart = 24'000;

// Returns the parts of the scenario, in order. The publisher sets time, session and sequence.
std::vector<scenario_info_t> to_messages(const bus::Scenario& scenario, const ConfiguredModems& modems);

}  // namespace halocline::channel_server
