// SPDX-License-Identifier: BSD-3-Clause
// Coverage map drawn by gnuplot: the quantities side by side at the best depth, and the mean delivery against
// depth.
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "channel_server/propagation/propagation.h"
#include "core/check.h"
#include "runs/plot/plot.h"
#include "simulation/coverage/coverage.h"
#include "simulation/coverage/coverage_files.h"

namespace halocline::clients {
namespace {

// Palette "deep" of cmocean from dark to light (Thyng et al. 2016); light means good reception.
constexpr const char* kPalette =
    "set palette defined (0 '#271a2c', 0.2 '#403c73', 0.4 '#3e6c96', 0.6 '#4c99a0', 0.8 '#6fc9a3', 1 "
    "'#fdfdcc')\n";

// Returns east and north in kilometres and the value of each cell; cells without sound or water are NaN.
std::string image_data(const Coverage& coverage, CoverageQuantity quantity, std::size_t depth) {
  const std::vector<double> values = coverage.values(quantity, depth);
  const CoverageArea& area = coverage.area;
  std::string text = "$map << EOD\n";
  for (std::size_t row = 0; row < area.side; ++row) {
    for (std::size_t column = 0; column < area.side; ++column) {
      const double value = values[row * area.side + column];
      const bool is_sound = !std::isnan(value) && value > channel_server::kSilence.value / 2;
      text += fmt::format("{:.6g} {:.6g} {}\n", area.east_m(column) / 1000, area.north_m(row) / 1000,
                          is_sound ? fmt::format("{:.6g}", value) : "NaN");
    }
  }
  return text + "EOD\n";
}

std::string map_of(const Coverage& coverage, CoverageQuantity quantity, std::size_t depth) {
  const QuantityMeaning& meaning = meaning_of(quantity);
  const std::string unit = std::string(meaning.unit) == "1" ? "" : std::string(", ") + meaning.unit;
  const std::string range = meaning.unit == std::string_view("1") ? "[0:1]" : "[*:*]";
  return image_data(coverage, quantity, depth) + "set title " +
         gnuplot_text(fmt::format("{}{} at {:g} m", meaning.meaning, unit, coverage.area.depths_m[depth])) +
         "\nset xlabel 'east, km'\nset ylabel 'north, km'\nset size ratio -1\nset xrange [*:*] noextend\nset "
         "yrange [*:*] noextend\nset cbrange " +
         range + "\nplot $map using 1:2:3 with image notitle\n";
}

std::string depth_chart(const Coverage& coverage) {
  std::string text = "$mean << EOD\n";
  for (std::size_t depth = 0; depth < coverage.area.depths_m.size(); ++depth) {
    if (const auto mean = coverage.mean_delivery(depth))
      text += fmt::format("{:.6g} {:g}\n", *mean, coverage.area.depths_m[depth]);
  }
  return text +
         "EOD\nset title 'mean over the map'\nset xlabel 'delivery probability'\nset ylabel 'depth, m'\n"
         "set size noratio\nset xrange [0:*]\nset yrange [*:*] reverse\nset grid\n"
         "plot $mean using 1:2 with linespoints pt 7 ps 0.6 lc rgb '#3e6c96' notitle\n";
}

}  // namespace

void write_coverage_picture(const Coverage& coverage, const CoverageFile& file, const std::string& path) {
  require_plot_file(path);
  const auto best = coverage.best_depth();
  require(best.has_value(), "the map holds no water at all: there is nothing to draw");
  const std::size_t panels = file.quantities.size() + 1;
  std::string script =
      fmt::format("set terminal pngcairo noenhanced size {},460 background rgb 'white'\n", 480 * panels) +
      kPalette + fmt::format("set multiplot layout 1,{} title {}\n", panels, gnuplot_text(file.title));
  for (const CoverageQuantity quantity : file.quantities) script += map_of(coverage, quantity, *best);
  run_gnuplot(script + depth_chart(coverage) + "unset multiplot\n", path);
}

}  // namespace halocline::clients
