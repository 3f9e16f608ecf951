// SPDX-License-Identifier: BSD-3-Clause
// Pictures drawn by gnuplot for a page: axes, images and curves whose colours follow the scheme of the page.
// The position of every coordinate is known, so that marks with texts can be drawn over them. gnuplot has no
// mark in the shape of a bow tie and writes no texts for a pointer, so such marks are drawn separately
// (`overlay`).
#pragma once

#include <string>
#include <string_view>

namespace halocline::clients {

struct Axis {
  double low = 0, high = 1;
  std::string title{};
  std::string tics = "autofreq";  // in gnuplot's syntax
};

struct Picture {
  double width_px = 600, height_px = 300;
  double left_px = 64, right_px = 12, top_px = 12, bottom_px = 44;  // margins around the axes
  Axis x, y;
  std::string commands{};  // plot commands with their data, executed after the axes are set
  std::string overlay{};   // SVG that is drawn on top
  std::string label{};     // description of the picture for readers who cannot see it
  bool has_grid = true;

  double x_px(double value) const {
    return left_px + (value - x.low) / (x.high - x.low) * (width_px - left_px - right_px);
  }
  double y_px(double value) const {
    return height_px - bottom_px - (value - y.low) / (y.high - y.low) * (height_px - top_px - bottom_px);
  }
};

// Returns " lc rgb '...'" for a colour of the page: ink, quiet, line, accent, seabed, seabed-edge, contour,
// v-0 to v-7 (vehicle_style.h).
std::string ink(std::string_view variable);

// Returns the picture as an SVG element. Throws as run_gnuplot (plot.h).
std::string drawn(const Picture& picture);

}  // namespace halocline::clients
