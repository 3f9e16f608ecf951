// What tells vehicles apart on the bus and in the water.
#pragma once

#include <cstdint>

namespace halocline::channel_server {

// Positive of a vehicle; 0 is broadcast as a destination (core/names.h) and a bare position as a link's end.
using VehicleId = std::int32_t;

}  // namespace halocline::channel_server
