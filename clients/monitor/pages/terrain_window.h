// A window of the terrain in the detail that a page wants, from the bathymetry service: in as many queries as it takes.
#pragma once

#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "clients/monitor/pages/frames.h"
#include "clients/monitor/pages/query_desk.h"

namespace halocline::monitor {

// South, west, spacing, rows and columns of a request; no depths. Throws InvalidArgument for what is missing.
DepthGrid terrain_window_in(const nlohmann::json& request);

// Fills the depths. `done` is called once; with null and a sentence when the service does not answer.
void collect_terrain(QueryDesk& queries, const DepthGrid& window,
                     const std::function<void(const DepthGrid* grid, const std::string& problem)>& done);

}  // namespace halocline::monitor
