// SPDX-License-Identifier: BSD-3-Clause
// Identities of vehicles on the bus and in the water.
#pragma once

#include <cstdint>

namespace halocline::channel_server {

// Positive for a vehicle. 0 is broadcast as a destination (core/names.h) and a bare position as the end of a
// link.
using VehicleId = std::int32_t;

}  // namespace halocline::channel_server
