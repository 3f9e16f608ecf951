// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/height_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace halocline::bathymetry {

void require_valid(const GridGeometry& geometry) {
  require_finite(geometry.first_x_m, "first_x_m of a grid");
  require_finite(geometry.first_y_m, "first_y_m of a grid");
  require_in_range(geometry.spacing_m, 1e-3, 1e6, "spacing_m of a grid", "m");
  require(geometry.posts_x >= 2 && geometry.posts_y >= 2, "a grid needs at least 2 x 2 posts");
  require(std::int64_t{geometry.posts_x} * geometry.posts_y <= kMaxTerrainPosts,
          "a grid holds at most 2^30 posts; take a smaller domain or a wider spacing");
}

bool is_no_data(const BilinearCell& cell) { return std::isnan(cell.z00 + cell.a + cell.b + cell.c); }

HeightGrid::HeightGrid(const GridGeometry& geometry, HugePageVector<float> posts)
    : geometry_(geometry), posts_(std::move(posts)) {
  require_valid(geometry_);
  const auto expected =
      static_cast<std::size_t>(geometry_.posts_x) * static_cast<std::size_t>(geometry_.posts_y);
  require(posts_.size() == expected, "a grid needs posts_x * posts_y posts");
  require(std::none_of(posts_.begin(), posts_.end(), [](float z) { return std::isinf(z); }),
          "a post is infinite; no data is NaN");
}

}  // namespace halocline::bathymetry
