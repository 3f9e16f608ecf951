// SPDX-License-Identifier: BSD-3-Clause
// Water whose sound speed varies along a link as well as with depth, for ray tracing: smooth, by bicubic
// patches.
//
// Model: columns of water (acoustics/sea/ray_water.h) at ascending ranges, all with the same knots, form
// rectangles. In each rectangle the speed is the bicubic Hermite polynomial (Press and others 2007, section
// 3.6) of its values and of c_r, c_z and c_rz at the four corners, the slopes of parabolas through a point
// and its two neighbours. Hence the speed and its gradient are continuous, and no kink makes a ray tube
// depend on the side of it on which a ray turns. Slopes along depth are limited after Huynh (1993, SIAM J.
// Numer. Anal. 30, 57): constant speed stays constant, a sharp bend has no overshoot, an extremum stays
// smooth. Beyond the last column the water is that of the column. Absorption is interpolated linearly over
// range between the two adjacent columns.
//
// Error relative to a differentiable function: fourth order in the spacing for the speed, second order for
// its curvature, first order next to the first and the last knot.
//
// Immutable: calls may overlap between threads. Ranges are from the source, m.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// The rectangle between the columns `strip` and strip + 1 in the layer below the knot `layer`.
struct SectionCell {
  std::size_t strip = 0, layer = 0;
};

// Sound speed at a position, m/s, its gradient along range and downwards, 1/s, and the second derivatives,
// 1/(m s).
struct LocalSpeed {
  double c, along, down, along_along, along_down, down_down;
};

// The speed in one rectangle; the polynomial is also defined beyond its edges.
class SpeedPatch {
 public:
  LocalSpeed at(double range_m, double depth_m) const;

 private:
  friend class RaySection;
  double range_ = 0, depth_ = 0, per_width_ = 0, per_height_ = 0;
  // Coefficients of u^i v^j, u and v the shares of width and height.
  std::array<std::array<double, 4>, 4> a_{};
};

// A vertical section of water.
class RaySection {
 public:
  // Makes a section of one or more columns, the first at range 0. Throws InvalidArgument when ranges do not
  // increase or knots differ.
  RaySection(std::vector<double> ranges_m, std::vector<RayWater> columns);

  const std::vector<RayWater>& columns() const { return columns_; }
  const std::vector<double>& depths_m() const { return columns_.front().depths_m(); }

  // The cell at a position. At a knot it is the layer above when the ray `rises`, otherwise the one below.
  SectionCell cell_at(double range_m, double depth_m, bool rises = false) const;
  // Range at which a strip ends, m; infinite for the strip beyond the last column.
  double end_of(std::size_t strip) const;
  SpeedPatch patch(const SectionCell& cell) const;
  double absorption_db_per_m(const SectionCell& cell, double range_m, double depth_m) const;
  // Speed at any position from range 0 on, m/s.
  double speed_at(double range_m, double depth_m) const;

 private:
  // Speed and its derivatives c_r, c_z and c_rz at a knot.
  struct Node {
    double c = 0, along = 0, down = 0, along_down = 0;
  };
  const Node& node(std::size_t column, std::size_t knot) const {
    return nodes_[column * depths_m().size() + knot];
  }

  std::vector<double> ranges_;
  std::vector<RayWater> columns_;
  std::vector<Node> nodes_;  // [column * knots + knot]
};

}  // namespace halocline::acoustics
