// SPDX-License-Identifier: BSD-3-Clause
// Depth over time: one strip for each vehicle, with the seabed below it and its commanded depth.
#pragma once

#include <string>

#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

inline constexpr std::size_t kDepthStrips = 12;  // maximum number of vehicles: those that moved farthest

// Returns SVG elements, one below the other; empty when no vehicle moved. Each line has at most 600 points,
// with its extremes. Throws as run_gnuplot (plot.h).
std::string depth_chart(const RunTimeline& timeline);

// False when the seabed is so far below every vehicle that no strip could show both.
bool is_seabed_drawn(const RunTimeline& timeline);

// Returns a sentence on the vehicles that moved and have no strip; empty when there is none.
std::string left_out_strips(const RunTimeline& timeline);

// Returns a sentence on the vehicles that did not move; empty when there is none.
std::string resting_vehicles(const RunTimeline& timeline);

}  // namespace halocline::clients
