// SPDX-License-Identifier: BSD-3-Clause
// Estimate of the size of a run's log, and of its memory. The log is estimated from rates, vehicles and
// duration.
//
// Each message counts with its size in a log: 28 bytes of the event, the channel's name, and the content as
// measured on the shipped scenarios. Accuracy: 15 % on those (a test runs some of them); a factor of 2 when
// packets are many and large.
#pragma once

#include "simulation/composition.h"

namespace halocline::clients {

// Returns the estimated size of the log in bytes, without CSV files.
double estimated_log_bytes(const ScenarioConfig& config);

// Returns the estimated memory of a run's terrain in bytes; a large terrain takes most of a run's memory.
// Throws as prepare_terrain.
double estimated_memory_bytes(const ScenarioConfig& config);

}  // namespace halocline::clients
