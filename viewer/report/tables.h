// SPDX-License-Identifier: BSD-3-Clause
// Tables of a report as HTML.
#pragma once

#include <string>

#include "runs/timeline/run_timeline.h"
#include "viewer/report/packet_links.h"

namespace halocline::clients {

inline constexpr std::size_t kMatrixVehicles = 24;  // maximum; the first ones of the run

// Returns the matrix of deliveries: share, counts and median SNR of every pair; empty without outcomes.
std::string link_matrix(const RunTimeline& timeline);

// Returns every outcome by its cause, with counts and shares, and the packets that were refused; empty when
// there are neither. A cause links to its first packet in the table of losses.
std::string outcome_table(const RunTimeline& timeline, const PacketLinks& links);

// Returns one row for each packet that was lost or refused, with a sentence on the reason; empty when there
// is none. Packets on the time line link to their marks there.
std::string loss_table(const RunTimeline& timeline, const PacketLinks& links);

// Returns the programs that took part and the messages that they missed; empty when none were missed.
std::string node_table(const RunTimeline& timeline);

}  // namespace halocline::clients
