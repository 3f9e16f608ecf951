// SPDX-License-Identifier: BSD-3-Clause
// Plan view of a run: seabed, contours, tracks, plans, and the places where packets were lost.
#pragma once

#include <string>

#include "runs/timeline/run_timeline.h"
#include "viewer/report/packet_links.h"

namespace halocline::clients {

// Returns an SVG element; empty when no vehicle has a position. Tracks have at most 400 points each and 30
// 000 together; at most 300 vehicles are drawn. Throws as run_gnuplot (plot.h).
std::string run_chart(const RunTimeline& timeline, const PacketLinks& links);

// Returns a sentence on the vehicles that are not drawn; empty when there is none.
std::string left_out_tracks(const RunTimeline& timeline);

// True when there are few enough vehicles to draw plans and a dot at every round instant.
bool has_details(const RunTimeline& timeline);
// Returns the time between two dots, s.
double time_dots_s(const RunTimeline& timeline);

}  // namespace halocline::clients
