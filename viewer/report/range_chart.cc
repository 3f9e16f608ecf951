// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/range_chart.h"

#include <vector>

#include <fmt/format.h>

#include "core/csv_table.h"
#include "runs/analysis/confidence.h"
#include "runs/timeline/delivery.h"
#include "viewer/report/chart_texts.h"
#include "viewer/report/picture.h"
#include "viewer/report/svg.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kSteps = 12;
constexpr double kLevel = 0.95;

}  // namespace

std::string range_chart(const RunTimeline& timeline) {
  const std::vector<RangeDelivery> ranges = delivery_by_range(timeline, kSteps);
  if (ranges.empty()) return "";
  const bool in_km = ranges.back().to_m >= 2000;
  const double unit_m = in_km ? 1000 : 1;
  Picture picture;
  picture.width_px = 484;
  picture.height_px = 300;
  picture.left_px = 40;
  picture.x = {0, ranges.back().to_m / unit_m, in_km ? "range, km" : "range, m"};
  picture.y = {0, 100, "received, %", "25"};
  picture.top_px = 30;
  picture.bottom_px = 56;
  picture.label = "Share of packets received against range, measured and predicted";
  std::string predicted, intervals;
  for (const RangeDelivery& range : ranges) {
    const double middle = (range.from_m + range.to_m) / 2 / unit_m;
    const double share = static_cast<double>(range.received) / static_cast<double>(range.packets);
    const ConfidenceInterval interval = wilson_interval(range.received, range.packets, kLevel);
    intervals += fmt::format("{} {:.3f} {:.3f} {:.3f}\n", format_number(middle), 100 * share,
                             100 * interval.low, 100 * interval.high);
    if (range.predicted)
      predicted += fmt::format("{} {:.3f}\n", format_number(middle), 100 * *range.predicted);
    const std::string prediction =
        range.predicted ? fmt::format("; the link tables predicted {:.0f} %", 100 * *range.predicted) : "";
    picture.overlay += fmt::format(
        R"(<circle cx="{}" cy="{}" r="4.5" class="measured">{}</circle>)", px(picture.x_px(middle)),
        px(picture.y_px(100 * share)),
        hover(fmt::format("{} to {}: {} of {} received, {:.0f} % (95 % interval {:.0f} to {:.0f} %){}",
                          distance_text(range.from_m), distance_text(range.to_m), range.received,
                          range.packets, 100 * share, 100 * interval.low, 100 * interval.high, prediction)));
  }
  picture.commands = "$measured << EOD\n" + intervals + "EOD\n";
  std::string plots;
  if (!predicted.empty()) {
    picture.commands += "$predicted << EOD\n" + predicted + "EOD\n";
    plots = "$predicted using 1:2 with lines lw 2 dt (6,4)" + ink("accent") + " notitle, ";
  }
  picture.commands +=
      "plot " + plots + "$measured using 1:2:3:4 with yerrorbars pt 0 lw 1.4" + ink("ink") + " notitle\n";
  return drawn(picture);
}

}  // namespace halocline::clients
