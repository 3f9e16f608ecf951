// SPDX-License-Identifier: BSD-3-Clause
// Series of numbers drawn into a PNG or SVG file, by gnuplot.
//
//   Plot plot{.title = "Arrivals", .charts = {{.x = "delay, s", .y = "level, dB"}}};
//   plot.charts[0].series.push_back({.title = "paths", .style = Series::kStems, .x = delays, .y = levels});
//   write_plot(plot, "arrivals.svg");
//
// Charts stand one below the other. Stems rise from the chart's lower edge (levels in dB have no zero to rise
// from), bars from 0; bars of several series stand side by side. Texts are taken as they are: no markup.
// gnuplot is started without a shell and reads its commands from a file of ours without a name; texts enter
// them as single-quoted strings, in which gnuplot expands nothing.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace halocline::clients {

struct Series {
  enum Style { kStems, kBars, kLines, kPoints };
  std::string title;  // empty: none in the key
  Style style = kLines;
  std::vector<double> x = {}, y = {};  // as many of each, finite
};

struct Chart {
  std::string x = {}, y = {};  // titles of the axes
  std::vector<Series> series = {};
  std::vector<std::string> categories = {};  // names at x = 0, 1, 2, ...; empty: numbers
  std::string when_empty = "no data";        // shown where no series has a point
};

struct Plot {
  std::string title = {};
  std::vector<Chart> charts;  // at least one
  int width_px = 900, chart_height_px = 400;
};

// Throws InvalidArgument unless the name ends in .png or .svg and is printable.
void require_plot_file(const std::string& file);

// The gnuplot script that draws to the standard output what `file` is to hold. Throws InvalidArgument when a
// series has more of one coordinate than of the other or a number that is not finite, when there is no chart,
// or for a file as above.
std::string gnuplot_script(const Plot& plot, const std::string& file);

struct NoGnuplot : std::runtime_error {
  NoGnuplot()
      : std::runtime_error("plots need gnuplot, which is not installed: apt-get install gnuplot-nox") {}
};

// Runs commands, with data between them as gnuplot takes it from its standard input; returns what they write
// to the standard output. Throws NoGnuplot; std::runtime_error when gnuplot fails, with its output.
std::string run_gnuplot(const std::string& commands);
// Replaces `file`, a .png or .svg, by the picture that the commands draw, when it is whole. Throws as above.
void run_gnuplot(const std::string& commands, const std::string& file);

// A text for gnuplot commands: quoted, nothing in it is special.
std::string gnuplot_text(const std::string& text);

// Throws InvalidArgument as above; NoGnuplot; std::runtime_error when gnuplot fails, with its output.
void write_plot(const Plot& plot, const std::string& file);

}  // namespace halocline::clients
