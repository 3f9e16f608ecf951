// SPDX-License-Identifier: BSD-3-Clause
// Bottom beyond the base grid of a terrain from a formula: the grid continues without end.
//
// Model. Posts continue at the same spacing; each is computed when it is needed, by the formula that made the
// others, and the surface between them is bilinear as in the grid (height_grid.h). So the two join without a
// step, and a ray is followed cell by cell as in grid_trace.h. Each cell costs four evaluations of the
// formula, which suits the few positions and rays that leave the grid.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "bathymetry/terrain/grid_trace.h"
#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

// Formula of z of the bottom at (x, y), local NED: finite everywhere.
using BottomFormula = std::function<double(double x_m, double y_m)>;

class EndlessBottom {
 public:
  // Greatest distance from the first post, in cells, at which rays are followed; longer rays end there.
  static constexpr int kMaxCells = 1 << 30;

  EndlessBottom(const GridGeometry& geometry, BottomFormula z_m)
      : geometry_(geometry), z_m_(std::move(z_m)) {}

  // Returns the cell of a position; its indices may be negative or beyond the grid. Empty for a position that
  // is not finite or beyond kMaxCells.
  std::optional<CellPosition> locate(double x_m, double y_m) const;
  BilinearCell cell(int i, int j) const;
  // Returns the first end of the ray within `interval`, anywhere.
  TraceResult trace(const GridRay& ray, Interval interval) const;

 private:
  float post(int i, int j) const { return static_cast<float>(z_m_(geometry_.x_at(i), geometry_.y_at(j))); }

  GridGeometry geometry_;
  BottomFormula z_m_;
};

}  // namespace halocline::bathymetry
