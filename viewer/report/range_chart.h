// SPDX-License-Identifier: BSD-3-Clause
// Share of packets received against range, with its 95 % confidence interval (Wilson) and the prediction of
// the link tables.
#pragma once

#include <string>

#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

// Returns an SVG element; empty without outcomes. Throws as run_gnuplot (plot.h).
std::string range_chart(const RunTimeline& timeline);

}  // namespace halocline::clients
