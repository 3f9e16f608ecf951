// SPDX-License-Identifier: BSD-3-Clause
// Best depth of reception along a track, over time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/terrain.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/coverage/coverage_links.h"
#include "simulation/coverage/sampling.h"
#include "simulation/link_survey.h"

namespace halocline::clients {

// Horizontal position on a track at a time.
struct TrackPlace {
  double time_s = 0, north_m = 0, east_m = 0;
};

// Reads a table with the columns time_s, north_m and east_m (core/csv_table.h). Throws InvalidArgument with
// everything that is wrong.
std::vector<TrackPlace> read_track(const std::string& path);

// Returns the track of a vehicle of the scenario, for which the scenario is run.
std::vector<TrackPlace> track_of(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                                 const std::string& vehicle, SimDuration every);

// Best depth at a position on the track.
struct DepthChoice {
  TrackPlace place;
  // Index of the depth with the greatest delivery; among equals the one with the greatest level. Empty: no
  // water.
  std::optional<std::size_t> best = {};
  Sample sample = {};  // at the best depth
};

// Returns for each position on the track which of the depths, below the surface, receives best from `from`
// over the scenario's bottom. Each position has a bearing of its own, so that only its depths can share rays.
std::vector<DepthChoice> best_depths(const ScenarioConfig& config,
                                     const std::shared_ptr<const bathymetry::Terrain>& terrain,
                                     const LinkSurveyEnd& from, const std::vector<TrackPlace>& track,
                                     const std::vector<double>& depths_m, int threads,
                                     RaySharing sharing = RaySharing::kNone);

// Returns a CSV table with the columns time_s, north_m, east_m, best_depth_m, delivery, level_db, delay_s;
// cells are empty where there is no water.
std::string track_csv(const std::vector<DepthChoice>& choices, const std::vector<double>& depths_m);

// Draws the best depth and the delivery at it against time. Throws as write_plot (plot/plot.h).
void write_track_picture(const std::vector<DepthChoice>& choices, const std::vector<double>& depths_m,
                         const std::string& title, const std::string& path);

}  // namespace halocline::clients
