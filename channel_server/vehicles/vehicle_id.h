// SPDX-License-Identifier: BSD-3-Clause
// Identities of vehicles on the bus and in the water.
#pragma once

#include <cstdint>
#include <utility>

namespace halocline::channel_server {

// Positive for a vehicle. 0 is broadcast as a destination (core/names.h) and a bare position as the end of a
// link.
using VehicleId = std::int32_t;

// Two vehicles, the lower id first.
using VehiclePair = std::pair<VehicleId, VehicleId>;
inline VehiclePair pair_of(VehicleId a, VehicleId b) { return a < b ? VehiclePair(a, b) : VehiclePair(b, a); }

}  // namespace halocline::channel_server
