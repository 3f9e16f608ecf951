// SPDX-License-Identifier: BSD-3-Clause
// Time line of packets: one lane for each vehicle, with transmissions as bars, receptions at their travel
// time, and the cause of a loss shown when the pointer rests on it. Written directly as SVG, because gnuplot
// writes no texts for a pointer.
#pragma once

#include <string>

#include "runs/timeline/run_timeline.h"
#include "viewer/report/packet_links.h"

namespace halocline::clients {

inline constexpr std::size_t kLanes = 16;        // maximum number of vehicles: those with the most packets
inline constexpr std::size_t kLaneMarks = 3000;  // maximum number of receptions

// Time line as SVG.
struct PacketLanes {
  std::string svg;   // empty: no packets
  std::string note;  // sentence on data left out; empty: none
};

// Draws the whole run if it fits, otherwise the interval with the most departures among those short enough.
// Adds the marks that it draws to `links`.
PacketLanes packet_lanes(const RunTimeline& timeline, PacketLinks& links);

}  // namespace halocline::clients
