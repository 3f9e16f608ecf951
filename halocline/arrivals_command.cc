// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/files/input_file.h"
#include "core/units.h"
#include "halocline/commands.h"
#include "runs/analysis/run_files.h"
#include "simulation/arrivals/arrival_output.h"
#include "simulation/arrivals/arrival_plot.h"
#include "simulation/arrivals/sea_files.h"

namespace halocline::clients {
namespace {

struct ArrivalsArguments {
  SeaDescription sea;
  std::string links, solver, format = "table", output, plot;
  double source_depth_m = 0, receiver_depth_m = 0;
  std::optional<double> range_m;
  bool force = false;
};

std::vector<acoustics::RayLink> links_of(const ArrivalsArguments& arguments) {
  require(arguments.links.empty() == arguments.range_m.has_value(),
          "give either --links or --range-m, not both");
  if (arguments.range_m) {
    require(*arguments.range_m >= 0,
            "range is " + format_number(*arguments.range_m) + " m; allowed is 0 and more");
    return {{arguments.source_depth_m, arguments.receiver_depth_m, *arguments.range_m}};
  }
  std::ifstream file = open_input(arguments.links);
  return read_links(file, arguments.links);
}

// Notes links whose path by one surface bounce, the steepest of those with at most one bounce, is left out.
void note_steep_paths(const std::vector<LinkArrivals>& found, double max_launch_angle_deg) {
  const auto is_steep = [&](const LinkArrivals& one) {
    const double height_m = one.link.source_depth_m + one.link.receiver_depth_m;
    return to_degrees(elementary::atan2(height_m, one.link.range_m)) > max_launch_angle_deg;
  };
  const auto first = std::find_if(found.begin(), found.end(), is_steep);
  if (first == found.end()) return;
  const auto others = std::count_if(first + 1, found.end(), is_steep);
  std::cerr << "note: at a range of " << format_number(first->link.range_m) << " m"
            << (others > 0 ? ", and of " + std::to_string(others) + " links more," : "")
            << " paths steeper than " << format_number(max_launch_angle_deg)
            << " degrees were not searched; --max-launch-angle-deg 90 searches all\n";
}

OutputFormat format_of(const std::string& name) {
  return name == "csv" ? OutputFormat::kCsv : name == "json" ? OutputFormat::kJson : OutputFormat::kTable;
}

int find_arrivals(const ArrivalsArguments& arguments) {
  if (!arguments.plot.empty()) require_plot_file(arguments.plot);
  require_free({{arguments.output, arguments.plot}, arguments.force},
               {arguments.links, arguments.sea.water, arguments.sea.bottom});
  const acoustics::RaySea sea = make_sea(arguments.sea);
  const auto solver = solver_of(arguments.solver);
  std::vector<LinkArrivals> found;
  for (const acoustics::RayLink& link : links_of(arguments))
    found.push_back({link, eigenrays(sea, link, solver)});
  note_steep_paths(found, arguments.sea.max_launch_angle_deg);
  if (!arguments.plot.empty()) write_plot(arrival_plot(found, "Arrivals"), arguments.plot);
  std::ostringstream text;  // nothing is written unless everything succeeds
  print_arrivals(text, found, format_of(arguments.format));
  write_output(arguments.output, text.str());
  return kDone;
}

void add_water_options(CLI::App& command, SeaDescription& sea) {
  command.add_option("--water", sea.water,
                     "profile: CSV (depth_m, sound_speed_mps), netCDF or built-in name");
  command.add_option("--latitude", sea.latitude_deg, "degrees: of the place in a netCDF of --water");
  command.add_option("--longitude", sea.longitude_deg, "likewise");
  command.add_option("--sound-speed-mps", sea.sound_speed_mps, "the same at every depth, instead of --water");
  command.add_option("--frequency-khz", sea.frequency_khz, "of absorption and reflection");
  command.add_option("--absorption", sea.absorption, "formula by name (see calc absorption), or none");
  command.add_option("--temperature-degc", sea.temperature_degc, "of the water that absorbs");
  command.add_option("--salinity-psu", sea.salinity_psu, "likewise");
  command.add_option("--ph", sea.ph, "likewise");
}

void add_boundary_options(CLI::App& command, SeaDescription& sea) {
  command.add_option("--bottom", sea.bottom, "profile along the link: CSV (range_m, depth_m)");
  command.add_option("--bottom-depth-m", sea.bottom_depth_m, "a flat bottom, instead of --bottom");
  command.add_option("--sediment", sea.sediment, "by name, such as MediumSand, instead of the next three");
  command.add_option("--bottom-density-ratio", sea.bottom_density_ratio, "to the water");
  command.add_option("--bottom-sound-speed-mps", sea.bottom_sound_speed_mps, "of the sediment");
  command.add_option("--bottom-attenuation-db", sea.bottom_attenuation_db, "per wavelength");
  command.add_option("--crease-angle-deg", sea.crease_angle_deg,
                     "facets that turn by less are samples of a smooth bottom; 0: every corner is sharp");
  command.add_option("--surface", sea.surface, "loss model: flat, apl-bubbles, eckart, coates, jones");
  command.add_option("--wind-mps", sea.wind_mps, "over the surface");
}

void add_ray_options(CLI::App& command, ArrivalsArguments& arguments) {
  command.add_option("--max-launch-angle-deg", arguments.sea.max_launch_angle_deg, "from the horizontal");
  command.add_flag("--steep-direct,!--no-steep-direct", arguments.sea.keep_steep_direct,
                   "keep the direct path however steep");
  command.add_option("--max-bounces", arguments.sea.max_bounces, "surface and bottom together");
  command.add_option(
      "--min-boundary-factor", arguments.sea.min_boundary_factor,
      "paths whose bounces leave less than this of what those of the strongest leave are dropped");
  command.add_option("--diffuse-below-db", arguments.sea.diffuse_below_db,
                     "over a rough bottom weaker paths come as power; 0: every path");
  command.add_option("--min-amplitude-db", arguments.sea.min_amplitude_db, "paths below are dropped");
  command.add_option("--solver", arguments.solver, "auto, images, snell or arcs");
}

}  // namespace

void add_arrivals_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ArrivalsArguments>();
  CLI::App* command =
      app.add_subcommand("arrivals", "Every path of sound of links through a sea given by tables");
  command->option_defaults()->always_capture_default();
  command->add_option("--links", arguments->links, "CSV: src_depth_m, rcv_depth_m, rcv_range_m");
  command->add_option("--source-depth-m", arguments->source_depth_m, "of one link, instead of --links");
  command->add_option("--receiver-depth-m", arguments->receiver_depth_m, "likewise");
  command->add_option("--range-m", arguments->range_m, "likewise");
  add_water_options(*command, arguments->sea);
  add_boundary_options(*command, arguments->sea);
  add_ray_options(*command, *arguments);
  command->add_option("--format", arguments->format, "table, csv or json")
      ->check(CLI::IsMember({"table", "csv", "json"}));
  command->add_option("--out", arguments->output, "file; default: stdout");
  command->add_option("--plot", arguments->plot,
                      "also draw level and angle against delay: FILE.png or FILE.svg");
  add_force_option(*command, arguments->force);
  command->footer(
      footer("  halocline arrivals --sound-speed-mps 1500 --bottom-depth-m 100 --source-depth-m 30 "
             "--receiver-depth-m 50 --range-m 2000\n"
             "  halocline arrivals --water munk.csv --bottom ridge.csv --links links.csv --format csv"));
  command->callback([arguments, &exit_code] { exit_code = find_arrivals(*arguments); });
}

}  // namespace halocline::clients
