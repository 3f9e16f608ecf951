// SPDX-License-Identifier: BSD-3-Clause
// Window of the terrain at the resolution that a page requests, fetched from the bathymetry service in as
// many queries as necessary.
#pragma once

#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "bus/messages/messages.h"
#include "viewer/pages/binary_messages.h"
#include "viewer/pages/query_desk.h"

namespace halocline::monitor {

// Returns the window of a request: corner, spacing, rows and columns; its depths are NaN. Throws
// InvalidArgument for missing members.
DepthGrid terrain_window_in(const nlohmann::json& request);

// Fetches the depths. `done` is called once; with null and a sentence when the service does not answer.
void collect_terrain(QueryDesk& queries, const DepthGrid& window,
                     const std::function<void(const DepthGrid* grid, const std::string& problem)>& done);

// Fetches the whole terrain at 97 x 97 posts at most, like the message TERRAIN, for a program that started
// after TERRAIN was published. `done` is not called when the service does not answer.
void collect_overview(QueryDesk& queries, const std::function<void(const terrain_tile_t& overview)>& done);

}  // namespace halocline::monitor
