// SPDX-License-Identifier: BSD-3-Clause
// Pictures by gnuplot for a page: axes, images and curves whose colours follow the page's scheme, and a known
// place of every coordinate, so that marks with texts of their own can be drawn over them.
// gnuplot has no mark in the shape of a bow tie and writes no text for a pointer to rest on, so such marks
// are ours (`overlay`).
#pragma once

#include <string>
#include <string_view>

namespace halocline::clients {

struct Axis {
  double low = 0, high = 1;
  std::string title{};
  std::string tics = "autofreq";  // as gnuplot takes them
};

struct Picture {
  double width_px = 600, height_px = 300;
  double left_px = 64, right_px = 12, top_px = 12, bottom_px = 44;  // margins around the axes
  Axis x, y;
  std::string commands{};  // plot commands with their data, after the axes are set
  std::string overlay{};   // SVG drawn over it
  std::string label{};     // what the picture shows, for a reader that does not see it
  bool has_grid = true;

  double x_px(double value) const {
    return left_px + (value - x.low) / (x.high - x.low) * (width_px - left_px - right_px);
  }
  double y_px(double value) const {
    return height_px - bottom_px - (value - y.low) / (y.high - y.low) * (height_px - top_px - bottom_px);
  }
};

// " lc rgb '...'" of a colour of the page: ink, quiet, line, accent, ground, ground-edge, contour, v-0 to v-7
// (vehicle_style.h).
std::string ink(std::string_view variable);

// The SVG element. Throws as run_gnuplot (plot.h).
std::string drawn(const Picture& picture);

}  // namespace halocline::clients
