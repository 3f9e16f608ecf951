// SPDX-License-Identifier: BSD-3-Clause
// Whether the vehicles of a scenario start in the water: a check that needs the terrain.
#pragma once

#include <string>

#include "bus/config/config.h"
#include "bus/runtime/scenario.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim {

// Refuses in `file` each vehicle that starts above the sea surface, under ground, or where the terrain is not
// known; those of other processes ("external") are theirs. `extent`: where the terrain lies, for a person.
// The errors are thrown by file.check_findings().
void check_starts(const bus::Scenario& scenario, const Seabed& seabed, const std::string& extent,
                  bus::ConfigFile& file);

}  // namespace halocline::vehicle_sim
