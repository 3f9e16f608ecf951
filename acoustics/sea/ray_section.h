// SPDX-License-Identifier: BSD-3-Clause
// Water whose sound speed changes along a link as well as with depth, as rays see it: smooth, by bicubic
// patches.
//
// Model: columns of water (acoustics/sea/ray_water.h) at rising ranges, all with the same knots, make
// rectangles. In each of them the speed is the bicubic Hermite polynomial (Press and others 2007, section
// 3.6) of its values at the four corners and of c_r, c_z and c_rz there, the slopes of parabolas through a
// point and its two neighbours. So the speed and its gradient are continuous, and there is no kink by which a
// ray tube would depend on which side of it a ray turns. Slopes along depth are limited after Huynh (1993,
// SIAM J. Numer. Anal. 30, 57): water of steady speed stays so, a sharp bend has no overshoot, an extreme
// stays smooth. Behind the last column the water is that of the column. Absorption is that of the two columns
// beside, mixed by range.
//
// Error against a function with derivatives: of fourth order in the spacing for the speed, of second for its
// curvature; no more than first beside the first and the last knot.
//
// Immutable: calls may overlap between threads. Ranges are from the source, m.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// The rectangle between columns `strip` and strip + 1 in the layer below knot `layer`.
struct SectionCell {
  std::size_t strip = 0, layer = 0;
};

// Sound speed at a place, m/s, and its derivatives along range and down, 1/s and 1/(m s).
struct LocalSpeed {
  double c, along, down, along_along, along_down, down_down;
};

// The speed in one rectangle; a polynomial, which goes on beyond its edges.
class SpeedPatch {
 public:
  LocalSpeed at(double range_m, double depth_m) const;

 private:
  friend class RaySection;
  double range_ = 0, depth_ = 0, per_width_ = 0, per_height_ = 0;
  std::array<std::array<double, 4>, 4> a_{};  // of u^i v^j, the shares of width and height
};

class RaySection {
 public:
  // At least one column, the first at range 0. Throws InvalidArgument when ranges do not rise or knots
  // differ.
  RaySection(std::vector<double> ranges_m, std::vector<RayWater> columns);

  const std::vector<RayWater>& columns() const { return columns_; }
  const std::vector<double>& depths_m() const { return columns_.front().depths_m(); }

  // At a knot `rises` decides between the layers.
  SectionCell cell_at(double range_m, double depth_m, bool rises = false) const;
  // Where it ends; the strip behind the last column has no end.
  double end_of(std::size_t strip) const;
  SpeedPatch patch(const SectionCell& cell) const;
  double absorption_db_per_m(const SectionCell& cell, double range_m, double depth_m) const;
  // At any place from range 0 on.
  double speed_at(double range_m, double depth_m) const;

 private:
  struct Node {
    double c = 0, along = 0, down = 0, along_down = 0;
  };
  const Node& node(std::size_t column, std::size_t knot) const {
    return nodes_[column * depths_m().size() + knot];
  }

  std::vector<double> ranges_;
  std::vector<RayWater> columns_;
  std::vector<Node> nodes_;  // of each column, at each knot
};

}  // namespace halocline::acoustics
