// SPDX-License-Identifier: BSD-3-Clause
// A window of the terrain in the detail that a page wants, from the bathymetry service: in as many queries as
// it takes.
#pragma once

#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "bus/messages.h"
#include "clients/monitor/pages/frames.h"
#include "clients/monitor/pages/query_desk.h"

namespace halocline::monitor {

// South, west, spacing, rows and columns of a request; no depths. Throws InvalidArgument for what is missing.
DepthGrid terrain_window_in(const nlohmann::json& request);

// Fills the depths. `done` is called once; with null and a sentence when the service does not answer.
void collect_terrain(QueryDesk& queries, const DepthGrid& window,
                     const std::function<void(const DepthGrid* grid, const std::string& problem)>& done);

// The whole terrain at 97 x 97 posts at most, as TERRAIN has it, for who came after that was published.
// `done` is not called when the service does not answer.
void collect_overview(QueryDesk& queries, const std::function<void(const terrain_tile_t& overview)>& done);

}  // namespace halocline::monitor
