// SPDX-License-Identifier: BSD-3-Clause
// Follows a ray over one grid to the first place where it meets the bilinear bottom, exactly and without
// leaks.
//
// Model: the ray's parameter interval is cut at cell (or pyramid block) boundaries. Cells are integers, and
// the parameter of boundary n is always computed afresh by the one expression (n - origin) / direction, for
// the exit of a block, for the choice of the child entered, for the neighbour. So the pieces tile the
// interval: no point of the ray belongs to no cell, whatever the rounding. In a cell bottom minus ray is a
// quadratic in the parameter; a value at or below zero on entry is a hit, which closes the seams that
// rounding leaves between cells. Blocks whose shallowest post lies below the ray's deepest point there are
// leapt over. Accuracy: 3e-10 m against long double on rays of 20 km
// (tests/bathymetry/terrain/ray_reference_test.cc holds 1e-6). Left out: rays from below the bottom (the
// caller tests the start). `trace_grid` takes one ray; wide_trace.h follows many by the same steps.
#pragma once

#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/shallowest_pyramid.h"
#include "core/frames.h"

namespace halocline::bathymetry {

// A ray in one grid's units: position = origin + direction t, where x, y count cells from post (0, 0), z and
// t are metres (local NED, down). No horizontal direction component is exactly 0.
struct GridRay {
  double origin_x = 0, origin_y = 0, origin_z_m = 0;
  double direction_x = 0, direction_y = 0, direction_z = 0;

  // The parameter at which the ray crosses the grid line x = n or y = n. The only place that computes one.
  double crossing_x(int n) const { return (n - origin_x) / direction_x; }
  double crossing_y(int n) const { return (n - origin_y) / direction_y; }
};

// direction: unit vector, local NED. A component nearer to 0 than 1e-20 becomes that (1e-16 m in 20 000 km),
// so that no division is 0 / 0.
GridRay to_grid_ray(const GridGeometry& geometry, const Vec3& origin_ned_m, const Vec3& direction);

// The pyramid level on which a search starts: blocks of 8 x 8 cells. Steep rays end there, long ones climb.
inline constexpr int kStartLevel = 3;

// A range of the ray's parameter, metres. Empty when begin >= end.
struct Interval {
  double begin_m = 0, end_m = 0;
  bool empty() const { return !(begin_m < end_m); }
};

// The cells [first_i, last_i) x [first_j, last_j) of a grid.
struct CellBlock {
  int first_i = 0, first_j = 0, last_i = 0, last_j = 0;
};
inline CellBlock all_cells(const GridGeometry& geometry) {
  return {0, 0, geometry.cells_x(), geometry.cells_y()};
}

// The part of `interval` above the block, by the crossings of the grid whose cells these are.
Interval clip_to_cells(const CellBlock& block, const GridRay& ray, Interval interval);

enum class TraceEnd { kPassed, kHit, kNoData };

struct TraceResult {
  TraceEnd end = TraceEnd::kPassed;
  double range_m = 0;    // of the hit, or of the entry into the no-data cell
  CellPosition at = {};  // valid with hit
};

// Clearances of a block, or of the ray in a cell, above this are open water: far above the rounding of the
// ray's depth (1e-12 m), far below what anyone measures.
inline constexpr double kSlackM = 1e-9;

// A block of the pyramid, or a cell: level 0. It covers the cells from (i << level, j << level).
struct Block {
  int level = 0, i = 0, j = 0;
};

// The block of the starting level that holds parameter t; t lies inside the grid.
Block start_block(const GridGeometry& geometry, const ShallowestPyramid& pyramid, const GridRay& ray,
                  double t);

// The end of the ray over the cell whose indices are (i, j), where it lies within `interval`.
TraceResult trace_cell(const BilinearCell& cell, const GridRay& ray, int i, int j, Interval interval);

// True when the ray leaves the pyramid's shallowest post above all of `interval`: nothing to follow.
bool clears_grid(const ShallowestPyramid& pyramid, const GridRay& ray, Interval interval);

// The first end of the ray within `interval`, which lies inside the grid (clip_to_cells). `passed` when the
// whole of it is in water over known bottom.
TraceResult trace_grid(const HeightGrid& grid, const ShallowestPyramid& pyramid, const GridRay& ray,
                       Interval interval);

}  // namespace halocline::bathymetry
