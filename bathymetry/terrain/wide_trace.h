// SPDX-License-Identifier: BSD-3-Clause
// Follows many rays over one grid, eight side by side: the answers of `trace_grid`, bit by bit, sooner.
//
// Model: the walk of ray_trace.h with a ray in each lane of vectors of eight doubles. A step takes every lane
// down into a quarter of its block or on to the next block. Lanes that have come to a single cell wait until
// some have, then their cells are looked at together; a cell that the ray does not surely clear is decided by
// `trace_cell`. A lane whose ray has ended takes the next. Every lane computes what the walk of a single ray
// computes, by the same operations of IEEE 754 and without fused ones; so an answer depends neither on the
// rays beside it nor on the instructions of the processor.
#pragma once

#include <span>

#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/ray_trace.h"
#include "bathymetry/terrain/shallowest_pyramid.h"

namespace halocline::bathymetry {

// A ray to follow over one grid, and what came of it.
struct GridTrace {
  GridRay ray;
  Interval interval;  // inside the grid (clip_to_cells), not empty
  TraceResult result = {};
};

// What the processor computes 2, 4 or 8 numbers at once with. (SSE2 stands for whatever every processor of
// the kind has.)
enum class VectorUnit { kSse2, kAvx2, kAvx512 };

// The widest that this processor has.
VectorUnit widest_vector_unit();

// Sets the result of each trace; none may be null. `unit`: one that the processor has.
void trace_grid(const HeightGrid& grid, const ShallowestPyramid& pyramid, std::span<GridTrace* const> traces,
                VectorUnit unit = widest_vector_unit());

}  // namespace halocline::bathymetry
