// SPDX-License-Identifier: BSD-3-Clause
// Plot of arrivals: stems of level against delay, and the angles below.
#pragma once

#include <string>
#include <vector>

#include "runs/plot/plot.h"
#include "simulation/arrivals/arrival_output.h"

namespace halocline::clients {

// Returns a plot with one series for each link; several links are named by their ends.
Plot arrival_plot(const std::vector<LinkArrivals>& links, const std::string& title);

}  // namespace halocline::clients
