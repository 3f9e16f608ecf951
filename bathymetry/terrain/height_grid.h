// SPDX-License-Identifier: BSD-3-Clause
// Regular grid of bottom depths in the local frame: the only form in which terrain is stored.
//
// Model. Posts (samples) lie spacing_m apart on a square lattice; i counts north (x), j counts east (y). A
// post holds z of the bottom, m, positive down from the terrain's datum (land is negative), or NaN for no
// data. Between four posts the surface is bilinear, with u north and v east, both 0..1:
//
//   z(u, v) = z00 + (z10 - z00) u + (z01 - z00) v + (z00 - z10 - z01 + z11) u v
//
// So it is continuous, exact on a plane, and straight along every cell edge. Two triangles per cell would
// differ from it by a quarter of the cell's twist (0.8 m on the rugged terrain of the benchmark). A cell with
// a no-data post is a no-data cell as a whole: nothing is interpolated from three posts. Posts have single
// precision, 0.25 mm at 4000 m. The surface is defined by the stored posts, and exact from there on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/huge_page_vector.h"

namespace halocline::bathymetry {

inline constexpr std::int64_t kMaxTerrainPosts =
    std::int64_t{1} << 30;  // limit of a grid, and of all grids of a terrain; 4 GiB of floats

// Positions of the posts of a grid: at least 2 x 2 and at most 2^30 posts.
struct GridGeometry {
  double first_x_m = 0;  // north of post (0, 0), local NED
  double first_y_m = 0;  // east of post (0, 0), local NED
  double spacing_m = 1;  // between neighbours in both directions; above 0
  int posts_x = 2;       // count towards north, 2 or more
  int posts_y = 2;       // count towards east, 2 or more

  int cells_x() const { return posts_x - 1; }
  int cells_y() const { return posts_y - 1; }
  double x_at(int i) const { return first_x_m + i * spacing_m; }
  double y_at(int j) const { return first_y_m + j * spacing_m; }
  double last_x_m() const { return x_at(cells_x()); }
  double last_y_m() const { return y_at(cells_y()); }
  bool operator==(const GridGeometry&) const = default;
};

// Position of a point of the plane: the cell that contains it, and the fractions in the cell.
struct CellPosition {
  int i = 0, j = 0;     // the cell's first post
  double u = 0, v = 0;  // 0..1 north and east of that post
};

// Depth over one cell as a polynomial in (u, v), so that the depth along a ray is quadratic.
struct BilinearCell {
  double z00 = 0;  // m
  double a = 0;    // dz/du at v = 0, m per cell
  double b = 0;    // dz/dv at u = 0, m per cell
  double c = 0;    // twist, m per cell squared

  // NaN in a no-data cell: the sum of the posts is NaN when one of them is.
  double depth(double u, double v) const { return z00 + a * u + (b + c * u) * v; }
  double slope_u(double v) const { return a + c * v; }
  double slope_v(double u) const { return b + c * u; }
};

// Grid that owns its posts. Immutable once built, except through `posts_for_editing`; const calls may overlap
// between threads.
class HeightGrid {
 public:
  // posts: z, metres down, index i * posts_y + j; NaN is no data, infinities are refused.
  // Throws InvalidArgument for an impossible geometry or a wrong number of posts.
  HeightGrid(const GridGeometry& geometry, HugePageVector<float> posts);

  const GridGeometry& geometry() const { return geometry_; }
  const HugePageVector<float>& posts() const { return posts_; }
  // Access for adding relief or blending, before a Terrain takes the grid.
  HugePageVector<float>& posts_for_editing() { return posts_; }

  float post(int i, int j) const { return posts_[index(i, j)]; }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(geometry_.posts_y) +
           static_cast<std::size_t>(j);
  }

  // Returns the cell that contains (x, y), local NED; the grid includes its edges. Empty outside, and for
  // NaN.
  std::optional<CellPosition> locate(double x_m, double y_m) const {
    const double gx = (x_m - geometry_.first_x_m) / geometry_.spacing_m;
    const double gy = (y_m - geometry_.first_y_m) / geometry_.spacing_m;
    if (!(gx >= 0 && gy >= 0 && gx <= geometry_.cells_x() && gy <= geometry_.cells_y())) return std::nullopt;
    const int i = gx < geometry_.cells_x() ? static_cast<int>(gx) : geometry_.cells_x() - 1;
    const int j = gy < geometry_.cells_y() ? static_cast<int>(gy) : geometry_.cells_y() - 1;
    return CellPosition{i, j, gx - i, gy - j};
  }

  // Returns the surface over cell (i, j), 0 <= i < cells_x, 0 <= j < cells_y. Its depths are NaN in a no-data
  // cell.
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

// True when a post of the cell is NaN: it is a no-data cell.
bool is_no_data(const BilinearCell& cell);

}  // namespace halocline::bathymetry
