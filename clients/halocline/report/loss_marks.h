// SPDX-License-Identifier: BSD-3-Clause
// Where packets were lost, as marks over the chart of a mission.
#pragma once

#include <string>

#include "clients/halocline/report/packet_links.h"
#include "clients/halocline/report/picture.h"
#include "clients/mission/mission_store.h"

namespace halocline::clients {

// SVG elements. Losses that would lie upon each other are one mark: one for each class of outcomes in a
// square of 14 pixels, or of more where there would be more than 200 marks. A mark links to the row of its
// first packet that the table of losses lists.
std::string loss_marks(const MissionStore& mission, const PacketLinks& links, const Picture& chart);

}  // namespace halocline::clients
