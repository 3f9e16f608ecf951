// SPDX-License-Identifier: BSD-3-Clause
// The tables of a report, as HTML.
#pragma once

#include <string>

#include "clients/halocline/report/packet_links.h"
#include "clients/mission/mission_store.h"

namespace halocline::clients {

inline constexpr std::size_t kMatrixVehicles = 24;  // at most, those met first

// Who received whom: share, counts and the median SNR of every pair; empty without outcomes.
std::string link_matrix(const MissionStore& mission);

// Every outcome by its cause, with counts and shares, and the packets that were refused; empty without
// either. A cause links to its first packet among those lost.
std::string outcome_table(const MissionStore& mission, const PacketLinks& links);

// One row a packet that was lost or refused, with a sentence; empty when there is none.
// Each packet that the time line shows links to its mark there.
std::string loss_table(const MissionStore& mission, const PacketLinks& links);

// The programs that took part and what they missed; empty where nothing was missed.
std::string node_table(const MissionStore& mission);

}  // namespace halocline::clients
