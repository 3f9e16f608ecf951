// SPDX-License-Identifier: BSD-3-Clause
// Pyramid of the shallowest depths in square blocks of cells: lets a ray skip all blocks that lie deeper than
// it goes.
//
// Model. A max pyramid of heights (in z, positive down, a min pyramid). Level L >= 1 consists of blocks of
// 2^L x 2^L cells; block (bi, bj) covers cells bi 2^L .. and all posts on its edges. Level 0, single cells,
// is not stored: the four posts are read instead. A block with a no-data post has -infinity: no ray passes it
// unexamined. Only this bound is kept, none of the deepest points, because rays come from the water. Cost: a
// third of the posts' memory; 0.02 s for 4096 x 4096 posts.
#pragma once

#include <cstddef>
#include <vector>

#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

class ShallowestPyramid {
 public:
  explicit ShallowestPyramid(const HeightGrid& grid);

  // Level whose single block covers the grid; at least 1.
  int top_level() const { return static_cast<int>(levels_.size()); }

  // Returns z, m, down, of the shallowest post of a block; level 1..top_level(), block inside the grid.
  float shallowest(int level, int bi, int bj) const {
    const Level& l = levels_[static_cast<std::size_t>(level - 1)];
    return depths_[l.offset + static_cast<std::size_t>(bi) * l.blocks_y + static_cast<std::size_t>(bj)];
  }

  // Blocks of a level for direct indexing: block (bi, bj) is first(level)[bi * row_length(level) + bj].
  const float* first(int level) const {
    return depths_.data() + levels_[static_cast<std::size_t>(level - 1)].offset;
  }
  std::size_t row_length(int level) const { return levels_[static_cast<std::size_t>(level - 1)].blocks_y; }

  float shallowest_of_all() const { return depths_.back(); }

 private:
  struct Level {
    std::size_t offset = 0;    // index of its first block in depths_
    std::size_t blocks_y = 0;  // row length
    std::size_t blocks_x = 0;
  };
  void reduce_posts(const HeightGrid& grid);
  void reduce_level(std::size_t below);

  std::vector<Level> levels_;  // [0] is level 1
  std::vector<float> depths_;
};

}  // namespace halocline::bathymetry
