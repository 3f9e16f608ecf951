// SPDX-License-Identifier: BSD-3-Clause
// Depth over time: a strip a vehicle, with the seabed under it and the depth it was commanded to.
#pragma once

#include <string>

#include "clients/mission/mission_store.h"

namespace halocline::clients {

inline constexpr std::size_t kDepthStrips = 12;  // vehicles at most: those that moved the most

// SVG elements, one below the other; empty where no vehicle moved. Each line has at most 600 points, extremes
// kept. Throws as run_gnuplot (plot.h).
std::string depth_chart(const MissionStore& mission);

// False where it lies far below every vehicle, so that no strip would show both.
bool is_seabed_drawn(const MissionStore& mission);

// A sentence on the vehicles that moved and have no strip; empty where there is none.
std::string left_out_strips(const MissionStore& mission);

// A sentence on the vehicles that stayed where they were; empty where there is none.
std::string resting_vehicles(const MissionStore& mission);

}  // namespace halocline::clients
