// SPDX-License-Identifier: BSD-3-Clause
// Check that the vehicles of a scenario start in the water, which needs the terrain.
#pragma once

#include <string>

#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim {

// Refuses in `file` each vehicle that starts above the sea surface, below the seabed, or where the terrain is
// not known. Vehicles of other processes ("external") are not checked. `extent`: description of the terrain's
// extent for the error text. The errors are thrown by file.check_findings().
void check_starts(const bus::Scenario& scenario, const Seabed& seabed, const std::string& extent,
                  bus::ConfigFile& file);

}  // namespace halocline::vehicle_sim
