// SPDX-License-Identifier: BSD-3-Clause
// Ray tracing over one grid: finds the first point where a ray meets the bilinear bottom, exactly and without
// leaks.
//
// Model. The ray's parameter interval is divided at the boundaries of cells (or pyramid blocks). Cells have
// integer indices, and the parameter of boundary n is always recomputed by the single expression
//
//   (n - origin) / direction
//
// for the exit of a block, for the choice of the child entered, and for the neighbour. So the pieces tile the
// interval: every point of the ray belongs to a cell, whatever the rounding. In a cell, bottom minus ray is a
// quadratic in the parameter. A value at or below zero on entry is a hit, which closes the seams that
// rounding leaves between cells. Blocks whose shallowest post lies below the ray's deepest point in them are
// skipped.
//
// Accuracy: 3e-10 m against long double on rays of 20 km (tests/bathymetry/terrain/ray_reference_test.cc
// requires 1e-6). Left out: rays from below the bottom (the caller checks the start). `trace_grid` follows
// one ray; wide_trace.h follows many by the same steps.
#pragma once

#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/shallowest_pyramid.h"
#include "core/frames.h"

namespace halocline::bathymetry {

// Ray in the units of one grid: position = origin + direction t, where x, y count cells from post (0, 0), and
// z and t are metres (local NED, down). No horizontal direction component is exactly 0.
struct GridRay {
  double origin_x = 0, origin_y = 0, origin_z_m = 0;
  double direction_x = 0, direction_y = 0, direction_z = 0;

  // Parameter at which the ray crosses the grid line x = n or y = n. No other code computes one.
  double crossing_x(int n) const { return (n - origin_x) / direction_x; }
  double crossing_y(int n) const { return (n - origin_y) / direction_y; }
};

// Converts a ray; `direction` is a unit vector in local NED. A horizontal component closer to 0 than 1e-20
// becomes 1e-20 (1e-16 m in 20 000 km), so that no division is 0 / 0.
GridRay to_grid_ray(const GridGeometry& geometry, const Vec3& origin_ned_m, const Vec3& direction);

// Pyramid level at which a search starts: blocks of 8 x 8 cells. Steep rays end there, long ones climb.
inline constexpr int kStartLevel = 3;

// Interval of the ray's parameter, m. Empty when begin >= end.
struct Interval {
  double begin_m = 0, end_m = 0;
  bool empty() const { return !(begin_m < end_m); }
};

// Cells [first_i, last_i) x [first_j, last_j) of a grid.
struct CellBlock {
  int first_i = 0, first_j = 0, last_i = 0, last_j = 0;
};
inline CellBlock all_cells(const GridGeometry& geometry) {
  return {0, 0, geometry.cells_x(), geometry.cells_y()};
}

// Returns the part of `interval` over the block, by the crossings of the grid to which the cells belong.
Interval clip_to_cells(const CellBlock& block, const GridRay& ray, Interval interval);

enum class TraceEnd { kPassed, kHit, kNoData };

struct TraceResult {
  TraceEnd end = TraceEnd::kPassed;
  double range_m = 0;    // at the hit, or at the entry into the no-data cell
  CellPosition at = {};  // set for a hit
};

// Clearance of a block, or of the ray in a cell, above which there is open water: far above the rounding of
// the ray's depth (1e-12 m), far below any measurement.
inline constexpr double kSlackM = 1e-9;

// PyramidBlock of the pyramid, or a cell at level 0. It covers the cells from (i << level, j << level).
struct PyramidBlock {
  int level = 0, i = 0, j = 0;
};

// Returns the block of the starting level that contains parameter t, which lies inside the grid.
PyramidBlock start_block(const GridGeometry& geometry, const ShallowestPyramid& pyramid, const GridRay& ray,
                         double t);

// Returns the end of the ray over the cell (i, j), if it lies within `interval`.
TraceResult trace_cell(const BilinearCell& cell, const GridRay& ray, int i, int j, Interval interval);

// True when the ray stays above the pyramid's shallowest post over all of `interval`: nothing to follow.
bool clears_grid(const ShallowestPyramid& pyramid, const GridRay& ray, Interval interval);

// Returns the first end of the ray within `interval`, which lies inside the grid (clip_to_cells); kPassed
// when all of it is in water over known bottom.
TraceResult trace_grid(const HeightGrid& grid, const ShallowestPyramid& pyramid, const GridRay& ray,
                       Interval interval);

}  // namespace halocline::bathymetry
