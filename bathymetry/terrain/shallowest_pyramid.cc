// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/shallowest_pyramid.h"

#include <algorithm>
#include <limits>

namespace halocline::bathymetry {
namespace {

// Returns min(a, b), where NaN (no data) is shallower than everything.
float shallower(float a, float b) {
  constexpr float kNoBound = -std::numeric_limits<float>::infinity();
  if (a != a || b != b) return kNoBound;
  return a < b ? a : b;
}

std::size_t half_rounded_up(std::size_t n) { return (n + 1) / 2; }

}  // namespace

ShallowestPyramid::ShallowestPyramid(const HeightGrid& grid) {
  std::size_t blocks_x = static_cast<std::size_t>(grid.geometry().cells_x());
  std::size_t blocks_y = static_cast<std::size_t>(grid.geometry().cells_y());
  std::size_t total = 0;
  do {
    blocks_x = half_rounded_up(blocks_x);
    blocks_y = half_rounded_up(blocks_y);
    levels_.push_back({total, blocks_y, blocks_x});
    total += blocks_x * blocks_y;
  } while (blocks_x * blocks_y > 1);
  depths_.resize(total);
  reduce_posts(grid);
  for (std::size_t below = 0; below + 1 < levels_.size(); ++below) reduce_level(below);
}

// Builds level 1: two cells and so three posts in each direction, fewer at the far edges.
void ShallowestPyramid::reduce_posts(const HeightGrid& grid) {
  const int posts_x = grid.geometry().posts_x, posts_y = grid.geometry().posts_y;
  std::vector<float> row(static_cast<std::size_t>(posts_y));
  for (std::size_t bi = 0; bi < levels_[0].blocks_x; ++bi) {
    const int i = static_cast<int>(2 * bi);
    const float* first = &grid.posts()[grid.index(i, 0)];
    const float* second = &grid.posts()[grid.index(i + 1, 0)];
    const float* third = &grid.posts()[grid.index(std::min(i + 2, posts_x - 1), 0)];
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = shallower(shallower(first[j], second[j]), third[j]);
    float* out = &depths_[levels_[0].offset + bi * levels_[0].blocks_y];
    for (std::size_t bj = 0; bj < levels_[0].blocks_y; ++bj) {
      const std::size_t j = 2 * bj;
      out[bj] = shallower(shallower(row[j], row[j + 1]), row[std::min(j + 2, row.size() - 1)]);
    }
  }
}

void ShallowestPyramid::reduce_level(std::size_t below) {
  const Level& from = levels_[below];
  const Level& to = levels_[below + 1];
  for (std::size_t bi = 0; bi < to.blocks_x; ++bi) {
    const float* first = &depths_[from.offset + 2 * bi * from.blocks_y];
    const float* second = &depths_[from.offset + std::min(2 * bi + 1, from.blocks_x - 1) * from.blocks_y];
    for (std::size_t bj = 0; bj < to.blocks_y; ++bj) {
      const std::size_t j = 2 * bj, k = std::min(j + 1, from.blocks_y - 1);
      depths_[to.offset + bi * to.blocks_y + bj] =
          shallower(shallower(first[j], first[k]), shallower(second[j], second[k]));
    }
  }
}

}  // namespace halocline::bathymetry
