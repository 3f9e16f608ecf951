// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/csv_table.h"
#include "runs/plot/plot.h"

namespace halocline::clients {
namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
  // Returns the span widened by `share` of its width on either side, with a width above 0 in any case.
  Span widened(double share) const {
    const double margin = high > low ? share * (high - low) : std::max(1.0, std::abs(high) * 0.1);
    return {low - margin, high + margin};
  }
  std::string text() const { return "[" + format_number(low) + ":" + format_number(high) + "]"; }
};

Span span_of(const Chart& chart, std::vector<double> Series::*values) {
  Span span;
  for (const Series& series : chart.series) {
    for (const double value : series.*values) span.take(value);
  }
  return span;
}

bool has(const Chart& chart, Series::Style style) {
  return std::any_of(chart.series.begin(), chart.series.end(),
                     [style](const Series& series) { return series.style == style; });
}

void check(const Chart& chart) {
  for (const Series& series : chart.series) {
    require(series.x.size() == series.y.size(), "a series to plot has as many y as x");
    const auto finite = [](double value) { return std::isfinite(value); };
    require(std::all_of(series.x.begin(), series.x.end(), finite) &&
                std::all_of(series.y.begin(), series.y.end(), finite),
            "a series to plot has finite numbers only");
  }
}

// Returns the space for the bars at one place: the least distance between two places.
double bar_room(const Chart& chart) {
  std::vector<double> places;
  for (const Series& series : chart.series) {
    if (series.style == Series::kBars) places.insert(places.end(), series.x.begin(), series.x.end());
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  double room = places.size() > 1 ? std::numeric_limits<double>::infinity() : 1;
  for (std::size_t i = 1; i < places.size(); ++i) room = std::min(room, places[i] - places[i - 1]);
  return room;
}

class ChartScript {
 public:
  ChartScript(const Chart& chart, int number) : chart_(chart), number_(number) {}

  std::string text() {
    check(chart_);
    const Span x = span_of(chart_, &Series::x);
    if (x.empty()) return empty_chart();
    set_axes(x);
    std::string plots;
    for (std::size_t i = 0; i < chart_.series.size(); ++i) {
      if (!chart_.series[i].x.empty()) plots += (plots.empty() ? "" : ", ") + plot_of(i);
    }
    return script_ + "plot " + plots + "\n";
  }

 private:
  std::string labels() const {
    return "set xlabel " + gnuplot_text(chart_.x) + "\nset ylabel " + gnuplot_text(chart_.y) + "\n";
  }

  std::string empty_chart() const {
    return labels() + "set label 1 " + gnuplot_text(chart_.when_empty) +
           " at graph 0.5,0.5 center\nset xrange [0:1]\nset yrange [0:1]\nunset xtics\nunset ytics\n"
           "plot NaN notitle\nunset label 1\n";
  }

  void set_axes(const Span& x) {
    script_ = labels();
    Span y = span_of(chart_, &Series::y);
    if (has(chart_, Series::kBars)) y.take(0);
    Span shown = y.widened(0.1);
    if (has(chart_, Series::kBars) && y.low == 0) shown.low = 0;
    base_ = shown.low;
    Span width = x.widened(0.05);
    if (has(chart_, Series::kBars)) width = {x.low - bar_room(chart_), x.high + bar_room(chart_)};
    script_ += "set xrange " + width.text() + "\nset yrange " + shown.text() + "\n";
    if (chart_.categories.empty()) {
      script_ += "set xtics autofreq\n";
      return;
    }
    std::string tics;
    for (std::size_t i = 0; i < chart_.categories.size(); ++i)
      tics += (i == 0 ? "" : ", ") + gnuplot_text(chart_.categories[i]) + " " + std::to_string(i);
    script_ += "set xtics rotate by -30 (" + tics + ")\n";
  }

  std::string data_name(std::size_t i) const {
    return "$data_" + std::to_string(number_) + "_" + std::to_string(i);
  }

  std::string plot_of(std::size_t i) {
    const Series& series = chart_.series[i];
    const std::string name = data_name(i);
    script_ += name + " << EOD\n";
    for (std::size_t k = 0; k < series.x.size(); ++k)
      script_ += format_number(series.x[k]) + " " + format_number(series.y[k]) + "\n";
    script_ += "EOD\n";
    const std::string title = series.title.empty() ? " notitle" : " title " + gnuplot_text(series.title);
    const std::string colour = " lc " + std::to_string(i + 1);
    switch (series.style) {
      case Series::kStems:
        return name + " using 1:(" + format_number(base_) + "):(0):($2-(" + format_number(base_) +
               ")) with vectors nohead lw 2" + colour + " notitle, " + name +
               " using 1:2 with points pt 7 ps 0.7" + colour + title;
      case Series::kBars:
        return bars_of(i, name) + colour + title;
      case Series::kPoints:
        return name + " using 1:2 with points pt 7 ps 0.7" + colour + title;
      case Series::kLines:
        break;
    }
    return name + " using 1:2 with lines lw 2" + colour + title;
  }

  std::string bars_of(std::size_t i, const std::string& name) const {
    const auto is_bar = [](const Series& series) { return series.style == Series::kBars; };
    const auto begin = chart_.series.begin();
    const auto place = std::count_if(begin, begin + static_cast<std::ptrdiff_t>(i), is_bar);
    const auto all = std::count_if(begin, chart_.series.end(), is_bar);
    const double width = 0.8 * bar_room(chart_) / static_cast<double>(all);
    const double shift = (static_cast<double>(place) - 0.5 * static_cast<double>(all - 1)) * width;
    return name + " using ($1+(" + format_number(shift) + ")):2:(" + format_number(width) +
           ") with boxes fs solid 0.7";
  }

  const Chart& chart_;
  int number_;
  std::string script_;
  double base_ = 0;  // lower end of stems
};

}  // namespace

// Doubles quotes and blanks out control characters: nothing else is special within gnuplot's single quotes.
std::string gnuplot_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += is_control(c) ? ' ' : c;
  }
  return out + "'";
}

void require_plot_file(const std::string& file) {
  require(file.ends_with(".png") || file.ends_with(".svg"),
          "'" + file + "' is no file to plot into; allowed are names that end in .png or .svg");
  require(std::none_of(file.begin(), file.end(), is_control), "the name of a plot holds control characters");
}

std::string gnuplot_script(const Plot& plot, const std::string& file) {
  require_plot_file(file);
  require(!plot.charts.empty(), "a plot needs a chart");
  const auto charts = static_cast<int>(plot.charts.size());
  const std::string terminal = file.ends_with(".png") ? "pngcairo" : "svg";
  std::string script = "set terminal " + terminal + " noenhanced size " + std::to_string(plot.width_px) +
                       "," + std::to_string(plot.chart_height_px * charts) + " background rgb 'white'\n" +
                       "set grid\nset key above\n" + "set multiplot layout " + std::to_string(charts) +
                       ",1 title " + gnuplot_text(plot.title) + "\n";
  for (int i = 0; i < charts; ++i) script += ChartScript(plot.charts[static_cast<std::size_t>(i)], i).text();
  return script + "unset multiplot\n";
}

}  // namespace halocline::clients
