// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/ostream.h>

#include "bathymetry/terrain/terrain.h"
#include "bus/transport/event_log.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/memory/memory_budget.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "halocline/commands.h"
#include "runs/analysis/run_files.h"
#include "runs/plot/plot.h"
#include "simulation/composition.h"
#include "simulation/coverage/coverage.h"
#include "simulation/coverage/coverage_bands.h"
#include "simulation/coverage/coverage_files.h"
#include "simulation/coverage/coverage_links.h"
#include "simulation/coverage/coverage_track.h"
#include "simulation/ensemble/link_ensemble.h"
#include "simulation/link_survey.h"
#include "simulation/log_estimate.h"

namespace halocline::clients {
namespace {

struct CoverageOptions {
  std::string scenario, from, depths, quantities = "delivery", sharing = "none", output, track, plot;
  std::vector<std::string> overrides;
  double cell_m = 0, range_m = 0, every_s = 10;
  std::size_t members = 0;
  int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
  bool force = false;
};

RaySharing sharing_of(const CoverageOptions& options) {
  if (options.sharing == "depths") return RaySharing::kDepths;
  return options.sharing == "ranges" ? RaySharing::kRanges : RaySharing::kNone;
}

CoverageArea area_of(const CoverageOptions& options, const LinkSurveyEnd& from) {
  require(options.cell_m > 0, "a map needs --cell, metres, above 0");
  CoverageArea area{.middle_north_m = from.position_ned_m.x(),
                    .middle_east_m = from.position_ned_m.y(),
                    .cell_m = options.cell_m,
                    .depths_m = depths_of(options.depths)};
  if (options.range_m > 0) {
    const double half = std::ceil(options.range_m / options.cell_m - 1e-9);
    require(half < 1e5, "--range over --cell is more than 100000");
    area.side = 2 * static_cast<std::size_t>(half);
  }
  require(area.side * area.side * area.depths_m.size() <= CoverageArea::kMaxCells,
          "the map has more than 20 million cells and depths: take larger cells, a shorter range or fewer "
          "depths");
  return area;
}

constexpr std::size_t kMany = 100'000;  // number of links, each of which takes a millisecond or more

// Notes the part of a run's prediction that exists between vehicles only, and how sure the noise is.
void note_what_is_left_out(const ScenarioConfig& config) {
  if (const std::string place = noise_place_text(config); !place.empty())
    fmt::print(std::cerr, "note: noise of the place: {}\n", place);
  if (config.channel_server.propagation.replay.is_wanted())
    fmt::print(std::cerr, "note: measured channels apply between vehicles alone: the map is modelled\n");
}

void note_terrain(const ScenarioConfig& config, const Coverage& coverage) {
  if (coverage.cells_beyond_terrain == 0) return;
  const std::size_t cells = coverage.area.side * coverage.area.side;
  fmt::print(std::cerr, "note: in {} of {} cells the terrain ends or has no data: {}\n",
             coverage.cells_beyond_terrain, cells,
             config.channel_server.propagation.rays.holds_terrain ? "its last depth is held"
                                                                  : "they have no value (NO_TERRAIN)");
}

// Writes the three maps of an ensemble and returns that of 50 %.
Coverage write_bands(const CoverageOptions& options, const ScenarioConfig& config, const LinkSurveyEnd& from,
                     const bathymetry::Terrain& terrain, const CoverageFile& file,
                     const std::function<Coverage(const ScenarioConfig&)>& computed) {
  const CoverageBands bands = coverage_bands(config, from, terrain, options.members, computed);
  for (std::size_t i = 0; i < bands.size(); ++i)
    write_coverage(bands[i], file, name_of_band(options.output, i));
  return bands[1];
}

int map(const CoverageOptions& options, const ScenarioConfig& config, const LinkSurveyEnd& from) {
  const CoverageArea area = area_of(options, from);
  const auto quantities = quantities_of(options.quantities);
  constexpr double kBytesACell = 8 * sizeof(double);  // six quantities, and two values while writing
  require_memory(static_cast<double>(area.side * area.side * area.depths_m.size() * (options.members + 1)) *
                         kBytesACell +
                     estimated_memory_bytes(config),
                 "the map", "take larger cells, a shorter range or fewer depths");
  note_what_is_left_out(config);
  const CoverageFile file{quantities,
                          {config.terrain.frame, to_radians(config.scenario.origin_latitude_deg),
                           to_radians(config.scenario.origin_longitude_deg)},
                          config.scenario.name + ": how " + options.from + " is heard"};
  const auto terrain = make_terrain(config).terrain;
  const std::size_t links = area.side * area.side * area.depths_m.size();
  if (sharing_of(options) == RaySharing::kNone && links > kMany && !level_z_m(config.terrain, *terrain))
    fmt::print(
        std::cerr,
        "{} links over terrain are searched one by one; --share-rays depths takes a third of the time, "
        "--share-rays ranges a twentieth\n",
        links);
  const auto computed = [&](const ScenarioConfig& sea) {
    return compute_coverage(sea, terrain, from, area, quantities, options.threads, sharing_of(options));
  };
  const Coverage coverage =
      options.members > 0 ? write_bands(options, config, from, *terrain, file, computed) : computed(config);
  if (options.members == 0) write_coverage(coverage, file, options.output);
  note_terrain(config, coverage);
  if (!options.plot.empty()) write_coverage_picture(coverage, file, options.plot);
  const auto best = coverage.best_depth();
  if (best) {
    fmt::print(
        std::cout,
        "best depth to hear {} at: {:g} m, delivery probability {:.3f} (mean over the water of the map)\n",
        options.from, area.depths_m[*best], *coverage.mean_delivery(*best));
  } else {
    fmt::print(std::cout, "the map holds no water at these depths\n");
  }
  return kDone;
}

int along_track(const CoverageOptions& options, const ScenarioConfig& config, const LinkSurveyEnd& from) {
  const auto depths_m = depths_of(options.depths);
  note_what_is_left_out(config);
  const auto terrain = make_terrain(config);
  const bool is_vehicle = config.scenario.find(options.track) != nullptr;
  const auto track =
      is_vehicle ? track_of(config, terrain, options.track, SimDuration::from_seconds(options.every_s))
                 : read_track(options.track);
  const auto choices =
      best_depths(config, terrain.terrain, from, track, depths_m, options.threads, sharing_of(options));
  replace_file(options.output, track_csv(choices, depths_m));
  if (!options.plot.empty())
    write_track_picture(choices, depths_m,
                        "Best depth to hear " + options.from + " at, along " + options.track, options.plot);
  double sum = 0;
  std::size_t count = 0;
  for (const DepthChoice& choice : choices) {
    if (!choice.best) continue;
    sum += choice.sample[0];
    ++count;
  }
  fmt::print(std::cout, "{}: {} places, delivery probability {:.3f} on average at the best depth of each\n",
             options.output, choices.size(), count > 0 ? sum / static_cast<double>(count) : 0.0);
  return kDone;
}

int coverage(const CoverageOptions& options) {
  bus::set_log_level(bus::LogLevel::kWarning);
  const bool is_track = !options.track.empty();
  if (is_track) {
    require(options.output.ends_with(".csv"),
            "'" + options.output + "' is no file for a track; allowed are names that end in .csv");
  } else {
    require_coverage_file(options.output);
  }
  if (!options.plot.empty()) require_plot_file(options.plot);
  require(!is_track || options.members == 0, "--ensemble goes with a map, not with --track");
  std::vector<std::string> outputs{options.output, options.plot};
  if (options.members > 0) {
    outputs.front() = name_of_band(options.output, 1);
    outputs.push_back(name_of_band(options.output, 0));
    outputs.push_back(name_of_band(options.output, 2));
  }
  require_free({outputs, options.force}, {options.scenario, options.track});
  const ScenarioConfig config =
      load_scenario(options.scenario, options.overrides, is_track ? ScenarioUse::kRun : ScenarioUse::kWater);
  const LinkSurveyEnd from = link_end(config, options.from);
  return is_track ? along_track(options, config, from) : map(options, config, from);
}

}  // namespace

void add_coverage_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CoverageOptions>();
  CLI::App* command =
      app.add_subcommand("coverage", "How well a place is heard: a map over depths, or along a track");
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  command
      ->add_option("--from", options->from,
                   "who is heard: a vehicle of the scenario (where it starts), or NORTH,EAST,DOWN in metres")
      ->required();
  command->add_option("--depths", options->depths, "of who hears it, m below the surface: FIRST:LAST:STEP")
      ->required();
  command
      ->add_option("--out", options->output,
                   "FILE.tif (GeoTIFF), .nc (netCDF, CF), .geojson (contours) or .png; with --track FILE.csv")
      ->required();
  command->add_option("--cell", options->cell_m, "side of a cell, m")->check(CLI::PositiveNumber);
  command
      ->add_option("--range", options->range_m,
                   "how far the map reaches to each side, m; default 100 cells, so 200 x 200")
      ->check(CLI::PositiveNumber);
  command->add_option(
      "--quantity", options->quantities,
      "what is written: delivery, snr, level, delay, delivery_low, delivery_high, with commas between");
  command
      ->add_option(
          "--share-rays", options->sharing,
          "over terrain, what shares rays: none (default; each link as 'halocline link'), depths of a place "
          "(a third of the time; a path in some hundred cells may be missed), or ranges of a bearing (a "
          "twentieth; levels are close, for pictures)")
      ->check(CLI::IsMember({"none", "depths", "ranges"}));
  command->add_option("--track", options->track,
                      "instead of a map the best depth along the way of this vehicle, or of a CSV file with "
                      "time_s, north_m, east_m");
  command->add_option("--every", options->every_s, "with --track VEHICLE: seconds between places; default 10")
      ->check(CLI::PositiveNumber);
  command->add_option("--plot", options->plot, "also a picture, FILE.png (of a track also .svg)");
  command
      ->add_option(
          "--ensemble", options->members,
          "number of seas, drawn from [uncertainty]: three maps in the place of one, 10, 50 and 90 % "
          "of each quantity, as FILE.10.tif, FILE.50.tif and FILE.90.tif")
      ->check(CLI::Range(std::size_t{0}, kMostMembers));
  command->add_option("--threads", options->threads, "default: as many as the machine has")
      ->check(CLI::Range(1, 64));
  command->add_option("--set", options->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  add_force_option(*command, options->force);
  command->footer(
      footer("  halocline coverage scenarios/shelf.toml --from buoy --depths 5:95:5 --cell 50 --quantity "
             "delivery,snr --out buoy.tif\n"
             "  halocline coverage scenarios/shelf.toml --from buoy --depths 5:95:5 --track shallow --out "
             "shallow.csv --plot shallow.png"));
  command->callback([options, &exit_code] { exit_code = coverage(*options); });
}

}  // namespace halocline::clients
