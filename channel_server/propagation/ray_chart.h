// SPDX-License-Identifier: BSD-3-Clause
// Draws the courses of the arrivals that a search over the seabed found, and splits their losses.
#pragma once

#include <vector>

#include "acoustics/modem/modem.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"
#include "channel_server/propagation/link_chart.h"

namespace halocline::channel_server {

// Returns the chart without guard weights. `rows`, by rising delay, have their arrivals and the loss at the
// surface. The eigenrays were searched over the link `searched`; `reversed`: from the receiver to the
// transmitter.
LinkChart chart_of(const acoustics::ProfiledSea& sea, const acoustics::RayLink& searched, bool reversed,
                   std::vector<LinkChart::Row> rows, const acoustics::Modem& transmitter,
                   const acoustics::Modem& receiver);

}  // namespace halocline::channel_server
