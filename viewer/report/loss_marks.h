// SPDX-License-Identifier: BSD-3-Clause
// Marks on the chart of a run at the places where packets were lost.
#pragma once

#include <string>

#include "runs/timeline/run_timeline.h"
#include "viewer/report/packet_links.h"
#include "viewer/report/picture.h"

namespace halocline::clients {

// Returns SVG elements. Losses that would overlap share one mark: one for each class of outcomes in a square
// of 14 pixels, or larger squares when there would be more than 200 marks. A mark links to the row of its
// first packet in the table of losses.
std::string loss_marks(const RunTimeline& timeline, const PacketLinks& links, const Picture& chart);

}  // namespace halocline::clients
