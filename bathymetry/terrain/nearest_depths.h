// SPDX-License-Identifier: BSD-3-Clause
// Depths of a grid with gaps filled: each post without data has that of the nearest post with data, counted
// in steps from neighbour to neighbour. For sound, which needs a bottom everywhere; never an answer to who
// asks for data.
#pragma once

#include "bathymetry/terrain/height_grid.h"
#include "core/huge_page_vector.h"

namespace halocline::bathymetry {

class NearestDepths {
 public:
  // A grid with at least one post with data; takes time and memory in proportion to its posts.
  explicit NearestDepths(const HeightGrid& grid);

  // At the post nearest to a place that is finite, in the grid or not.
  double at(double x_m, double y_m) const;

 private:
  GridGeometry geometry_;
  HugePageVector<float> z_m_;
};

}  // namespace halocline::bathymetry
