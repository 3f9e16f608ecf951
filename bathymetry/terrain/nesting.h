// SPDX-License-Identifier: BSD-3-Clause
// Fitting of a fine grid into the coarser grid around it, so that the two surfaces meet without a step.
//
// Model. The fine grid covers whole cells of the grid around it and its spacing divides that grid's, so along
// its border every kink of the coarse surface is at a post of the fine one. With d the distance of a post
// from the border and w the blend width,
//
//   post = z_around + (z_fine - z_around) min(1, d / w)
//
// The border itself (d = 0) lies on the surface around, also for w = 0. Where the surface around is unknown,
// the fine post is unchanged. Accuracy: the rounding of float posts, 0.25 mm at 4000 m.
#pragma once

#include <cstddef>

#include "bathymetry/terrain/grid_trace.h"
#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

// Throws InvalidArgument, naming the nested grid by `number` (from 0), unless `fine` is aligned inside
// `around`.
void require_nested(const GridGeometry& fine, const GridGeometry& around, std::size_t number);

// Returns the cells of `around` under a grid that passed require_nested.
CellBlock cells_covered(const GridGeometry& fine, const GridGeometry& around);

// True when the two rectangles share an area; a shared edge is not one.
bool overlap(const GridGeometry& one, const GridGeometry& other);

// Blends the posts of `fine` inside its border into the surface of `around`. `fill_holes`: its no-data posts
// take the depth of the surface around. blend_width_m: 0 or more.
void blend_into(const HeightGrid& around, double blend_width_m, bool fill_holes, HeightGrid& fine);

}  // namespace halocline::bathymetry
