// SPDX-License-Identifier: BSD-3-Clause
// Plots of number series as PNG or SVG files, drawn by gnuplot.
//
//   Plot plot{.title = "Arrivals", .charts = {{.x = "delay, s", .y = "level, dB"}}};
//   plot.charts[0].series.push_back({.title = "paths", .style = Series::kStems, .x = delays, .y = levels});
//   write_plot(plot, "arrivals.svg");
//
// Charts are placed one below the other. Stems rise from the lower edge of the chart (levels in dB have no
// natural zero), bars from 0; bars of several series stand side by side. Texts contain no markup. gnuplot is
// started without a shell and reads its commands from an unnamed temporary file; texts are passed as
// single-quoted strings, in which gnuplot expands nothing.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace halocline::clients {

struct Series {
  enum Style { kStems, kBars, kLines, kPoints };
  std::string title;  // empty: not in the key
  Style style = kLines;
  std::vector<double> x = {}, y = {};  // equal in size, finite
};

struct Chart {
  std::string x = {}, y = {};  // titles of the axes
  std::vector<Series> series = {};
  std::vector<std::string> categories = {};  // names at x = 0, 1, 2, ...; empty: numbers
  std::string when_empty = "no data";        // shown when no series has a point
};

struct Plot {
  std::string title = {};
  std::vector<Chart> charts;  // at least one
  int width_px = 900, chart_height_px = 400;
};

// Throws InvalidArgument unless the name ends in .png or .svg and is printable.
void require_plot_file(const std::string& file);

// Returns the gnuplot script that writes the contents of `file` to standard output. Throws InvalidArgument
// when a series has different numbers of x and y or a number that is not finite, when there is no chart, or
// for a name of `file` that require_plot_file() refuses.
std::string gnuplot_script(const Plot& plot, const std::string& file);

// Thrown when gnuplot is not installed.
struct NoGnuplot : std::runtime_error {
  NoGnuplot()
      : std::runtime_error("plots need gnuplot, which is not installed: apt-get install gnuplot-nox") {}
};

// Runs commands, which may contain data as gnuplot reads them from standard input, and returns their standard
// output. Throws NoGnuplot; std::runtime_error with gnuplot's messages when it fails.
std::string run_gnuplot(const std::string& commands);
// Runs commands and replaces `file`, a .png or .svg, when the picture is complete. Throws as above.
void run_gnuplot(const std::string& commands, const std::string& file);

// Quotes a text for gnuplot commands, so that no character of it is special.
std::string gnuplot_text(const std::string& text);

// Draws a plot into a file. Throws InvalidArgument as gnuplot_script(); NoGnuplot; std::runtime_error with
// gnuplot's messages when it fails.
void write_plot(const Plot& plot, const std::string& file);

}  // namespace halocline::clients
