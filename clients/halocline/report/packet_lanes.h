// SPDX-License-Identifier: BSD-3-Clause
// The time line of packets: a lane a vehicle, transmissions as bars, receptions at their travel time, the
// cause of each loss under the pointer. Written as SVG directly: gnuplot writes no text for a pointer to rest
// on.
#pragma once

#include <string>

#include "clients/halocline/report/packet_links.h"
#include "clients/mission/mission_store.h"

namespace halocline::clients {

inline constexpr std::size_t kLanes = 16;        // vehicles at most: those with the most packets
inline constexpr std::size_t kLaneMarks = 3000;  // receptions at most

struct PacketLanes {
  std::string svg;   // empty: no packets
  std::string note;  // a sentence on what is left out; empty: nothing
};

// All of it where it fits, else the stretch of time that holds the most outcomes of as many as fit. Adds the
// marks that it draws to `links`.
PacketLanes packet_lanes(const MissionStore& mission, PacketLinks& links);

}  // namespace halocline::clients
