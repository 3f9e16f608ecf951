// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/coverage_track.h"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>

#include "channel_server/propagation/seabed_map.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/files/input_file.h"
#include "core/frames.h"
#include "runs/plot/plot.h"
#include "simulation/link_surveyor.h"
#include "simulation/vehicle_track.h"

namespace halocline::clients {

std::vector<TrackPlace> read_track(const std::string& path) {
  std::ifstream in = open_input(path);
  std::vector<std::string> errors;
  const CsvTable table = read_csv(in, errors);
  std::array<std::size_t, 3> columns{};
  constexpr std::array kNames{"time_s", "north_m", "east_m"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto column = table.column(kNames[i]);
    if (!column) errors.push_back(std::string("it has no column ") + kNames[i]);
    columns[i] = column.value_or(0);
  }
  std::vector<TrackPlace> track;
  for (const CsvLine& row : table.rows) {
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto number = parse_number(row.cells[columns[i]]);
      if (!number) errors.push_back(fmt::format("line {}: {} is no number", row.number, kNames[i]));
      numbers[i] = number.value_or(0);
    }
    track.push_back({numbers[0], numbers[1], numbers[2]});
  }
  std::string all;
  for (const std::string& error : errors) all += "\n" + error;
  require(errors.empty(), "the track " + path + ":" + all);
  return track;
}

std::vector<TrackPlace> track_of(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                                 const std::string& vehicle, SimDuration every) {
  const SimTime end = SimTime() + config.scenario.duration;
  const VehicleTrack way(record_run(config, terrain, end), vehicle);
  std::vector<TrackPlace> track;
  for (SimTime t; t <= end; t = t + every) {
    const Vec3 place = way.at(t).position_ned_m;
    track.push_back({t.seconds(), place.x(), place.y()});
  }
  return track;
}

std::vector<DepthChoice> best_depths(const ScenarioConfig& config,
                                     const std::shared_ptr<const bathymetry::Terrain>& terrain,
                                     const LinkSurveyEnd& from, const std::vector<TrackPlace>& track,
                                     const std::vector<double>& depths_m, int threads, RaySharing sharing) {
  require_above_seabed(*terrain, from);
  const CoverageLinks links({config, terrain, from});
  channel_server::SeabedMap seabed = links.seabed_map();
  const auto place_of = [&](const TrackPlace& place, double depth_m) {
    return Vec3(place.north_m, place.east_m, depth_m + config.scenario.sea_surface_z_m);
  };
  for (const TrackPlace& place : track) links.survey(place_of(place, 0), seabed);
  std::vector<DepthChoice> choices(track.size());
  links.share(threads, track.size(), [&](LinkSurveyor& surveyor, std::size_t i) {
    choices[i].place = track[i];
    const Vec3 surface = place_of(track[i], 0);
    const auto bottom_z_m = seabed_z_m(*terrain, surface);
    const LinkSurveyor::Seabed profile = links.bottom(surface, seabed);
    std::vector<double> z_m;  // depths that are in the water
    for (const double depth_m : depths_m) {
      const double at_m = place_of(track[i], depth_m).z();
      if (bottom_z_m && at_m <= *bottom_z_m) z_m.push_back(at_m);
    }
    const std::vector<Sample> samples = links.links_to_one_place(surveyor, surface, z_m, profile, sharing);
    const auto best = std::max_element(samples.begin(), samples.end());
    if (best == samples.end()) return;
    choices[i].best = static_cast<std::size_t>(best - samples.begin());
    choices[i].sample = *best;
  });
  return choices;
}

std::string track_csv(const std::vector<DepthChoice>& choices, const std::vector<double>& depths_m) {
  std::string text = "time_s,north_m,east_m,best_depth_m,delivery,level_db,delay_s\n";
  for (const auto& [place, best, sample] : choices) {
    text += fmt::format("{},{},{},", format_number(place.time_s), format_number(place.north_m),
                        format_number(place.east_m));
    text += best ? fmt::format("{},{:.6f},{:.4f},{:.9f}\n", format_number(depths_m[*best]), sample[0],
                               sample[1], sample[2])
                 : ",,,\n";
  }
  return text;
}

void write_track_picture(const std::vector<DepthChoice>& choices, const std::vector<double>& depths_m,
                         const std::string& title, const std::string& path) {
  Series depth, delivery;
  depth.style = Series::kPoints;
  for (const auto& [place, best, sample] : choices) {
    if (!best) continue;
    depth.x.push_back(place.time_s);
    depth.y.push_back(-depths_m[*best]);
    delivery.x.push_back(place.time_s);
    delivery.y.push_back(sample[0]);
  }
  write_plot({.title = title,
              .charts = {{.x = "time, s", .y = "best depth, m (up)", .series = {depth}},
                         {.x = "time, s", .y = "delivery probability there", .series = {delivery}}},
              .chart_height_px = 280},
             path);
}

}  // namespace halocline::clients
