// SPDX-License-Identifier: BSD-3-Clause
// Simulation times of tests.
#pragma once

#include <cstdint>

#include "core/sim_time.h"

namespace halocline::testing {

inline SimTime at_ms(std::int64_t ms) { return SimTime() + SimDuration::from_milliseconds(ms); }

}  // namespace halocline::testing
