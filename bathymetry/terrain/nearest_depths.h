// SPDX-License-Identifier: BSD-3-Clause
// Depths of a grid with its gaps filled: each post without data has the depth of the nearest post with data,
// counted in steps from neighbour to neighbour. For acoustics, which needs a bottom everywhere; never used to
// answer queries for data.
#pragma once

#include "bathymetry/terrain/height_grid.h"
#include "core/huge_page_vector.h"

namespace halocline::bathymetry {

class NearestDepths {
 public:
  // `grid` must have at least one post with data. Time and memory are proportional to its posts.
  explicit NearestDepths(const HeightGrid& grid);

  // Returns the depth at the post nearest to a finite position, inside or outside of the grid.
  double at(double x_m, double y_m) const;

 private:
  GridGeometry geometry_;
  HugePageVector<float> z_m_;
};

}  // namespace halocline::bathymetry
