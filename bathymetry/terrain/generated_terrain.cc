// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/generated_terrain.h"

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "core/elementary.h"
#include "core/huge_page_vector.h"

namespace halocline::bathymetry {
namespace {

// Greater than the depth of any sea and the height of any mountain.
constexpr double kMaxDepthM = 12'000;

double gaussian(double distance_m, double scale_m) {
  const double d = distance_m / scale_m;
  return elementary::exp(-0.5 * d * d);
}

double depth_at(const FlatShape& flat, double, double) { return flat.depth_m; }

double depth_at(const SlopeShape& slope, double x_m, double y_m) {
  const double z_m = slope.depth_m + slope.slope * (x_m * elementary::cos(slope.azimuth_rad) +
                                                    y_m * elementary::sin(slope.azimuth_rad));
  return std::clamp(z_m, -kMaxDepthM, kMaxDepthM);
}

double depth_at(const RidgeShape& ridge, double x_m, double y_m) {
  const double across = (y_m - ridge.crest_y_m) * elementary::cos(ridge.azimuth_rad) -
                        (x_m - ridge.crest_x_m) * elementary::sin(ridge.azimuth_rad);
  return ridge.depth_m - ridge.height_m * gaussian(across, ridge.half_width_m);
}

double depth_at(const SeamountShape& mount, double x_m, double y_m) {
  const double distance = elementary::hypot(x_m - mount.summit_x_m, y_m - mount.summit_y_m);
  return mount.depth_m - mount.height_m * gaussian(distance, mount.radius_m);
}

void require_depth(double depth_m) { require_in_range(depth_m, -kMaxDepthM, kMaxDepthM, "depth_m", "m"); }

void require_possible(const FlatShape& flat) { require_depth(flat.depth_m); }

void require_possible(const SlopeShape& slope) {
  require_depth(slope.depth_m);
  require_in_range(slope.slope, -10, 10, "slope");
  require_finite(slope.azimuth_rad, "azimuth of the slope");
}

void require_possible(const RidgeShape& ridge) {
  require_depth(ridge.depth_m);
  require_in_range(ridge.height_m, -kMaxDepthM, kMaxDepthM, "height_m of the ridge", "m");
  require_in_range(ridge.half_width_m, 1e-3, 1e6, "half_width_m of the ridge", "m");
  require_finite(ridge.crest_x_m + ridge.crest_y_m + ridge.azimuth_rad, "crest of the ridge");
}

void require_possible(const SeamountShape& mount) {
  require_depth(mount.depth_m);
  require_in_range(mount.height_m, -kMaxDepthM, kMaxDepthM, "height_m of the seamount", "m");
  require_in_range(mount.radius_m, 1e-3, 1e6, "radius_m of the seamount", "m");
  require_finite(mount.summit_x_m + mount.summit_y_m, "summit of the seamount");
}

}  // namespace

double depth_of(const Shape& shape, double x_m, double y_m) {
  return std::visit([&](const auto& s) { return depth_at(s, x_m, y_m); }, shape);
}

HeightGrid make_grid(const GridGeometry& geometry, const Shape& shape) {
  std::visit([](const auto& s) { require_possible(s); }, shape);
  return make_grid(geometry, [&](double x_m, double y_m) { return depth_of(shape, x_m, y_m); });
}

HeightGrid make_grid(const GridGeometry& geometry, const std::function<double(double, double)>& z_m) {
  require_valid(geometry);
  HugePageVector<float> posts;
  posts.reserve(static_cast<std::size_t>(geometry.posts_x) * static_cast<std::size_t>(geometry.posts_y));
  for (int i = 0; i < geometry.posts_x; ++i) {
    for (int j = 0; j < geometry.posts_y; ++j) {
      posts.push_back(static_cast<float>(z_m(geometry.x_at(i), geometry.y_at(j))));
    }
  }
  return HeightGrid(geometry, std::move(posts));
}

}  // namespace halocline::bathymetry
