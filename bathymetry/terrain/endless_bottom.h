// SPDX-License-Identifier: BSD-3-Clause
// The bottom past the base grid of a terrain from a formula: the grid goes on without end.
//
// Model: its posts go on at the same spacing, each computed where it is needed by the formula that made the
// others, and the surface between them is bilinear as in the grid (height_grid.h). So the two join without a
// step, and a ray is followed cell by cell by the steps of ray_trace.h. Each cell costs four evaluations of
// the formula: for the places and rays that leave the grid, not for many.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/ray_trace.h"

namespace halocline::bathymetry {

// z of the bottom at (x, y), local NED: finite everywhere.
using BottomFormula = std::function<double(double x_m, double y_m)>;

class EndlessBottom {
 public:
  // Cells are followed so far from the first post, either way: a ray that goes on ends there.
  static constexpr int kMaxCells = 1 << 30;

  EndlessBottom(const GridGeometry& geometry, BottomFormula z_m)
      : geometry_(geometry), z_m_(std::move(z_m)) {}

  // Indices below 0 and beyond the grid count on. Empty for a place that is not finite or beyond kMaxCells.
  std::optional<CellPosition> locate(double x_m, double y_m) const;
  BilinearCell cell(int i, int j) const;
  // The first end of the ray within `interval`, anywhere.
  TraceResult trace(const GridRay& ray, Interval interval) const;

 private:
  float post(int i, int j) const { return static_cast<float>(z_m_(geometry_.x_at(i), geometry_.y_at(j))); }

  GridGeometry geometry_;
  BottomFormula z_m_;
};

}  // namespace halocline::bathymetry
