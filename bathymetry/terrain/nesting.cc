// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/nesting.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/check.h"
#include "core/huge_page_vector.h"

namespace halocline::bathymetry {
namespace {

// Tolerance in spacings for coordinates on the same grid line: configurations are decimal.
constexpr double kAlignmentTolerance = 1e-6;

bool is_whole(double value) { return std::abs(value - std::round(value)) <= kAlignmentTolerance; }

double surface_depth(const HeightGrid& grid, double x_m, double y_m) {
  const GridGeometry& g = grid.geometry();
  const auto at =
      grid.locate(std::clamp(x_m, g.first_x_m, g.last_x_m()), std::clamp(y_m, g.first_y_m, g.last_y_m()));
  return at ? grid.cell(at->i, at->j).depth(at->u, at->v) : std::nan("");
}

}  // namespace

void require_nested(const GridGeometry& fine, const GridGeometry& around, std::size_t number) {
  const std::string name = "nested grid " + std::to_string(number);
  const auto in_cells = [&](double metres) { return metres / around.spacing_m; };
  const double first_i = in_cells(fine.first_x_m - around.first_x_m);
  const double first_j = in_cells(fine.first_y_m - around.first_y_m);
  const double last_i = in_cells(fine.last_x_m() - around.first_x_m);
  const double last_j = in_cells(fine.last_y_m() - around.first_y_m);
  require(first_i > -kAlignmentTolerance && first_j > -kAlignmentTolerance &&
              last_i < around.cells_x() + kAlignmentTolerance &&
              last_j < around.cells_y() + kAlignmentTolerance,
          name + " reaches out of the grid it lies in");
  require(is_whole(first_i) && is_whole(first_j) && is_whole(last_i) && is_whole(last_j),
          name + " does not cover whole cells of the grid it lies in");
  require(is_whole(around.spacing_m / fine.spacing_m) && around.spacing_m / fine.spacing_m > 0.5,
          name + ": the spacing of the grid around must be a whole multiple of its own");
}

CellBlock cells_covered(const GridGeometry& fine, const GridGeometry& around) {
  const auto line = [&](double metres) { return static_cast<int>(std::lround(metres / around.spacing_m)); };
  return {line(fine.first_x_m - around.first_x_m), line(fine.first_y_m - around.first_y_m),
          line(fine.last_x_m() - around.first_x_m), line(fine.last_y_m() - around.first_y_m)};
}

bool overlap(const GridGeometry& one, const GridGeometry& other) {
  const double edge = kAlignmentTolerance * std::min(one.spacing_m, other.spacing_m);
  return std::min(one.last_x_m(), other.last_x_m()) - std::max(one.first_x_m, other.first_x_m) > edge &&
         std::min(one.last_y_m(), other.last_y_m()) - std::max(one.first_y_m, other.first_y_m) > edge;
}

void blend_into(const HeightGrid& around, double blend_width_m, bool fill_holes, HeightGrid& fine) {
  const GridGeometry& g = fine.geometry();
  HugePageVector<float>& posts = fine.posts_for_editing();
  for (int i = 0; i < g.posts_x; ++i) {
    for (int j = 0; j < g.posts_y; ++j) {
      float& post = posts[fine.index(i, j)];
      const int steps = std::min(std::min(i, g.cells_x() - i), std::min(j, g.cells_y() - j));
      const double from_border = steps * g.spacing_m;
      const bool hole = std::isnan(post);
      if (hole ? !fill_holes : (steps > 0 && from_border >= blend_width_m)) continue;
      const double z_around = surface_depth(around, g.x_at(i), g.y_at(j));
      if (std::isnan(z_around)) continue;
      const double weight = hole || steps == 0 ? 0 : from_border / blend_width_m;
      post = static_cast<float>(z_around + (hole ? 0 : weight * (double{post} - z_around)));
    }
  }
}

}  // namespace halocline::bathymetry
