// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/arrivals/arrival_plot.h"

#include "acoustics/rays/eigenray.h"
#include "core/csv_table.h"
#include "core/units.h"

namespace halocline::clients {
namespace {

std::string name_of(const acoustics::RayLink& link) {
  return format_number(link.source_depth_m) + " m to " + format_number(link.receiver_depth_m) + " m deep, " +
         format_number(link.range_m) + " m away";
}

}  // namespace

Plot arrival_plot(const std::vector<LinkArrivals>& links, const std::string& title) {
  const bool modems = !links.empty() && links.front().modems_known;
  Chart levels{.x = "delay, s",
               .y = modems ? "received level, dB re 1 uPa" : "level, dB re the source level"};
  Chart angles{.x = "delay, s", .y = "angle below the horizontal, deg"};
  for (const LinkArrivals& found : links) {
    const std::string name = links.size() > 1 ? name_of(found.link) : "";
    Series level{.title = name, .style = Series::kStems};
    Series launch{.title = links.size() > 1 ? "" : "launch", .style = Series::kPoints};
    Series arrival{.title = links.size() > 1 ? name : "arrival", .style = Series::kPoints};
    for (std::size_t i = 0; i < found.eigenrays.paths.size(); ++i) {
      const acoustics::Eigenray& path = found.eigenrays.paths[i];
      for (Series* series : {&level, &launch, &arrival}) series->x.push_back(path.delay_s);
      level.y.push_back(path_level_db(found, i));
      launch.y.push_back(to_degrees(path.launch_angle_rad));
      arrival.y.push_back(to_degrees(path.arrival_angle_rad));
    }
    levels.series.push_back(level);
    if (links.size() == 1) angles.series.push_back(launch);
    angles.series.push_back(arrival);
    levels.when_empty = angles.when_empty = why_silent(found);
  }
  return {.title = title, .charts = {levels, angles}};
}

}  // namespace halocline::clients
