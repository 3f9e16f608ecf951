// SPDX-License-Identifier: BSD-3-Clause
// The best depth to be heard along a way, over time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/terrain.h"
#include "clients/halocline/coverage/coverage_links.h"
#include "clients/halocline/coverage/sampling.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/scenario/link_survey.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct TrackPlace {
  double time_s = 0, north_m = 0, east_m = 0;
};

// A table of columns time_s, north_m and east_m (core/csv_table.h). Throws InvalidArgument with everything
// that is wrong.
std::vector<TrackPlace> read_track(const std::string& path);

// Where a vehicle of the scenario goes: the scenario is run for it.
std::vector<TrackPlace> track_of(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                                 const std::string& vehicle, SimDuration every);

struct DepthChoice {
  TrackPlace place;
  std::optional<std::size_t> best =
      {};  // index of the depth of the greatest delivery, of equals of the greatest level; empty: no water
  Sample sample = {};  // there
};

// Each place has a bearing of its own, so that its depths alone share rays. At each place which of the
// depths, below the surface, hears `from` best, over the scenario's bottom.
std::vector<DepthChoice> best_depths(const ScenarioConfig& config,
                                     const std::shared_ptr<const bathymetry::Terrain>& terrain,
                                     const LinkSurveyEnd& from, const std::vector<TrackPlace>& track,
                                     const std::vector<double>& depths_m, int threads,
                                     RaySharing sharing = RaySharing::kNone);

// Columns time_s, north_m, east_m, best_depth_m, delivery, level_db, delay_s; empty cells where there is no
// water.
std::string track_csv(const std::vector<DepthChoice>& choices, const std::vector<double>& depths_m);

// Best depth and delivery there against time. Throws as write_plot (plot/plot.h).
void write_track_picture(const std::vector<DepthChoice>& choices, const std::vector<double>& depths_m,
                         const std::string& title, const std::string& path);

}  // namespace halocline::clients
