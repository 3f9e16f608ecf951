// SPDX-License-Identifier: BSD-3-Clause
// A regular grid of bottom depths in the local frame: the only form in which terrain is stored.
//
// Model: posts (samples) lie spacing_m apart on a square lattice, i counts north (x), j counts east (y). A
// post holds z of the bottom, metres, positive down from the terrain's datum (land is negative), or NaN: no
// data. Between four posts the surface is bilinear,
//   z(u, v) = z00 + (z10 - z00) u + (z01 - z00) v + (z00 - z10 - z01 + z11) u v,   u north, v east, both
//   0..1,
// hence continuous, exact on a plane, and straight along every cell edge. Two triangles a cell would differ
// from it by a quarter of the cell's twist (0.8 m on the rugged terrain of the benchmark). A cell with a
// no-data post is a no-data cell as a whole: nothing is interpolated from three posts. Accuracy: posts are
// float: 0.25 mm at 4000 m. The surface is defined by the stored posts, and exact from there on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/huge_page_vector.h"

namespace halocline::bathymetry {

inline constexpr std::int64_t kMaxTerrainPosts =
    std::int64_t{1} << 30;  // of a grid, and of all of a terrain; 4 GiB of floats

// Where the posts of a grid lie. At least 2 x 2 and at most 2^30 posts.
struct GridGeometry {
  double first_x_m = 0;  // north of post (0, 0), local NED
  double first_y_m = 0;  // east of post (0, 0), local NED
  double spacing_m = 1;  // between neighbours, both ways; above 0
  int posts_x = 2;       // towards north, from 2
  int posts_y = 2;       // towards east, from 2

  int cells_x() const { return posts_x - 1; }
  int cells_y() const { return posts_y - 1; }
  double x_at(int i) const { return first_x_m + i * spacing_m; }
  double y_at(int j) const { return first_y_m + j * spacing_m; }
  double last_x_m() const { return x_at(cells_x()); }
  double last_y_m() const { return y_at(cells_y()); }
  bool operator==(const GridGeometry&) const = default;
};

// A point of the plane as the cell that holds it and the place in the cell.
struct CellPosition {
  int i = 0, j = 0;     // the cell's first post
  double u = 0, v = 0;  // 0..1 north and east of that post
};

// Depth over one cell, written as a polynomial in (u, v) so that a ray through it is a quadratic.
struct BilinearCell {
  double z00 = 0;  // m
  double a = 0;    // dz/du at v = 0, m a cell
  double b = 0;    // dz/dv at u = 0, m a cell
  double c = 0;    // twist, m a cell squared

  // NaN in a no-data cell: the sum of the posts is NaN when one of them is.
  double depth(double u, double v) const { return z00 + a * u + (b + c * u) * v; }
  double slope_u(double v) const { return a + c * v; }
  double slope_v(double u) const { return b + c * u; }
};

// Owns its posts. Immutable once built but for `posts_for_editing`; const calls may overlap between threads.
class HeightGrid {
 public:
  // posts: z, metres down, index i * posts_y + j; NaN is no data, infinities are refused.
  // Throws InvalidArgument for an impossible geometry or a wrong number of posts.
  HeightGrid(const GridGeometry& geometry, HugePageVector<float> posts);

  const GridGeometry& geometry() const { return geometry_; }
  const HugePageVector<float>& posts() const { return posts_; }
  // For those who add relief or blend before a Terrain takes the grid.
  HugePageVector<float>& posts_for_editing() { return posts_; }

  float post(int i, int j) const { return posts_[index(i, j)]; }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(geometry_.posts_y) +
           static_cast<std::size_t>(j);
  }

  // The cell that holds (x, y), local NED; edges belong to the grid. Empty outside, and for NaN.
  std::optional<CellPosition> locate(double x_m, double y_m) const {
    const double gx = (x_m - geometry_.first_x_m) / geometry_.spacing_m;
    const double gy = (y_m - geometry_.first_y_m) / geometry_.spacing_m;
    if (!(gx >= 0 && gy >= 0 && gx <= geometry_.cells_x() && gy <= geometry_.cells_y())) return std::nullopt;
    const int i = gx < geometry_.cells_x() ? static_cast<int>(gx) : geometry_.cells_x() - 1;
    const int j = gy < geometry_.cells_y() ? static_cast<int>(gy) : geometry_.cells_y() - 1;
    return CellPosition{i, j, gx - i, gy - j};
  }

  // The surface over cell (i, j), 0 <= i < cells_x, 0 <= j < cells_y. All NaN-valued in a no-data cell.
  BilinearCell cell(int i, int j) const {
    const float* low = posts_.data() + index(i, j);
    const float* high = low + geometry_.posts_y;
    const double z00 = low[0], z01 = low[1], z10 = high[0], z11 = high[1];
    return {z00, z10 - z00, z01 - z00, (z00 - z10) + (z11 - z01)};
  }

 private:
  GridGeometry geometry_;
  HugePageVector<float> posts_;
};

// Throws InvalidArgument unless the geometry is possible.
void require_valid(const GridGeometry& geometry);

// True when a post is NaN. A cell of which this holds is a no-data cell.
bool is_no_data(const BilinearCell& cell);

}  // namespace halocline::bathymetry
