// SPDX-License-Identifier: BSD-3-Clause
// Ray tracing of many rays over one grid in vectors: the results of `trace_grid` for single rays, bit by bit,
// but faster.
//
// Model. The walk of grid_trace.h with a ray in each lane of vectors of 2, 4 or 8 doubles. A step moves every
// lane down into a quarter of its block or on to the next block. Lanes that have reached a single cell wait
// until enough of them have, then their cells are examined together. A cell that the ray does not certainly
// clear is decided by `trace_cell`. A lane whose ray has ended takes the next ray. Every lane computes what
// the walk of a single ray computes, by the same IEEE 754 operations without fused ones, so a result depends
// neither on the rays beside it nor on the instructions of the processor.
#pragma once

#include <span>

#include "bathymetry/terrain/grid_trace.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/shallowest_pyramid.h"

namespace halocline::bathymetry {

// Ray to follow over one grid, and its result.
struct GridTrace {
  GridRay ray;
  Interval interval;  // inside the grid (clip_to_cells), not empty
  TraceResult result = {};
};

// Vector units that compute 2, 4 or 8 numbers at once. kSse2 represents what every processor of the
// architecture has.
enum class VectorUnit { kSse2, kAvx2, kAvx512 };

VectorUnit widest_vector_unit();

// Sets the result of each trace; none may be null. The processor must have `unit`.
void trace_grid(const HeightGrid& grid, const ShallowestPyramid& pyramid, std::span<GridTrace* const> traces,
                VectorUnit unit = widest_vector_unit());

}  // namespace halocline::bathymetry
