// SPDX-License-Identifier: BSD-3-Clause
// The mission seen from above: seabed, contours, tracks, plans, and where packets were lost.
#pragma once

#include <string>

#include "clients/halocline/report/packet_links.h"
#include "clients/mission/mission_store.h"

namespace halocline::clients {

// An SVG element; empty where no vehicle has a place. Tracks have at most 400 points each and 30 000
// together, 300 vehicles at most are drawn.
// Throws as run_gnuplot (plot.h).
std::string mission_chart(const MissionStore& mission, const PacketLinks& links);

// A sentence on the vehicles that are not drawn; empty where there is none.
std::string left_out_tracks(const MissionStore& mission);

// Whether there are few enough vehicles for plans and for a dot at every round instant, and the seconds
// between two dots.
bool has_details(const MissionStore& mission);
double time_dots_s(const MissionStore& mission);

}  // namespace halocline::clients
