// SPDX-License-Identifier: BSD-3-Clause
// How large the log of a run becomes, and its memory. The log is estimated from rates, vehicles and duration.
//
// Each message counts with its size in a log: 28 bytes of the event, the channel's name, and its content, as
// measured on the shipped scenarios. Accuracy: 15 % on those (a test runs some of them), a factor of 2 where
// the bottom's echoes are surveyed for straight paths, or where packets are many and large.
#pragma once

#include "clients/halocline/scenario/composition.h"

namespace halocline::clients {

// Bytes, CSVs not counted.
double estimated_log_bytes(const ScenarioConfig& config);

// Bytes of memory that a run takes for its terrain, which is most of it where it is large. Throws as
// prepare_terrain.
double estimated_memory_bytes(const ScenarioConfig& config);

}  // namespace halocline::clients
