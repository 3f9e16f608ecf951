// SPDX-License-Identifier: BSD-3-Clause
// The slow, plain answer that the fast rays are held against: long double, every cell crossing, no pyramid.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry::testing {

struct ReferenceHit {
  bool hit = false;
  long double range_m = 0;
  long double min_clearance_m = std::numeric_limits<long double>::infinity();  // before the hit, bottom - ray
  long double approach = 0;  // |d(clearance)/d(range)| at the hit: below 1e-3 the range is ill-conditioned
};

// First root in [0, length] of a + b s + c s^2, or a negative number.
inline long double reference_root(long double a, long double b, long double c, long double length) {
  if (a <= 0) return 0;
  long double best = -1;
  const auto consider = [&](long double s) {
    if (s >= 0 && s <= length && (best < 0 || s < best)) best = s;
  };
  const long double discriminant = b * b - 4 * a * c;
  if (discriminant >= 0) {
    const long double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
    if (c != 0) consider(q / c);
    if (q != 0) consider(a / q);
  }
  return best;
}

// The ray has a unit direction and begins above the bottom, inside the grid; the walk ends at the grid's
// edge.
inline ReferenceHit reference_trace(const HeightGrid& grid, const Ray& ray) {
  const GridGeometry& g = grid.geometry();
  const long double h = g.spacing_m;
  const long double ox = (static_cast<long double>(ray.origin_ned_m.x()) - g.first_x_m) / h;
  const long double oy = (static_cast<long double>(ray.origin_ned_m.y()) - g.first_y_m) / h;
  const long double dx = ray.direction.x() / h, dy = ray.direction.y() / h, dz = ray.direction.z();
  std::vector<long double> cuts{0, static_cast<long double>(ray.max_range_m)};
  const auto cut = [&](long double o, long double d, int cells) {
    if (d == 0) return;
    const long double a = o, b = o + d * ray.max_range_m;
    const int low = std::max(0, static_cast<int>(std::floor(std::min(a, b))));
    const int high = std::min(cells, static_cast<int>(std::ceil(std::max(a, b))));
    for (int n = low; n <= high; ++n) {
      const long double t = (n - o) / d;
      if (t > 0 && t < ray.max_range_m) cuts.push_back(t);
    }
  };
  cut(ox, dx, g.cells_x());
  cut(oy, dy, g.cells_y());
  std::sort(cuts.begin(), cuts.end());
  ReferenceHit out;
  for (std::size_t n = 0; n + 1 < cuts.size(); ++n) {
    const long double t = cuts[n], length = cuts[n + 1] - t, middle = t + length / 2;
    const long double mx = ox + dx * middle, my = oy + dy * middle;
    if (length <= 0) continue;
    if (mx < 0 || my < 0 || mx > g.cells_x() || my > g.cells_y()) return out;
    const int i = std::min(static_cast<int>(mx), g.cells_x() - 1),
              j = std::min(static_cast<int>(my), g.cells_y() - 1);
    const long double z00 = grid.post(i, j), z10 = grid.post(i + 1, j), z01 = grid.post(i, j + 1),
                      z11 = grid.post(i + 1, j + 1), twist = z00 - z10 - z01 + z11;
    const long double u = ox + dx * t - i, v = oy + dy * t - j;
    const long double a =
        z00 + (z10 - z00) * u + (z01 - z00) * v + twist * u * v - (ray.origin_ned_m.z() + dz * t);
    const long double b = (z10 - z00 + twist * v) * dx + (z01 - z00 + twist * u) * dy - dz,
                      c = twist * dx * dy;
    const long double s = reference_root(a, b, c, length);
    if (s >= 0) {
      out.hit = true;
      out.range_m = t + s;
      out.approach = std::abs(b + 2 * c * s);
      return out;
    }
  }
  return out;
}

}  // namespace halocline::bathymetry::testing
