// SPDX-License-Identifier: BSD-3-Clause
// Arrivals as a picture: level against delay as stems, and the angles below.
#pragma once

#include <string>
#include <vector>

#include "clients/halocline/arrivals/arrival_output.h"
#include "clients/halocline/plot/plot.h"

namespace halocline::clients {

// A series for each link; of several links each is named by its ends.
Plot arrival_plot(const std::vector<LinkArrivals>& links, const std::string& title);

}  // namespace halocline::clients
