// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/suspect_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace halocline::bathymetry {
namespace {

constexpr float kDeepestM = 12'000, kHighestM = 9'500;
constexpr float kMark = 9999;
constexpr float kMaxStepM = 2000;  // between neighbouring posts of real terrain

bool is_mark(float value) { return std::abs(value) == kMark; }

// Whether a neighbour that is no mark stands within a believable step.
bool has_believable_neighbour(const RasterWindow& window, int row, int column) {
  const float value =
      window.depths_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(window.columns) +
                      static_cast<std::size_t>(column)];
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, window.rows - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, window.columns - 1); ++c) {
      const float other =
          window.depths_m[static_cast<std::size_t>(r) * static_cast<std::size_t>(window.columns) +
                          static_cast<std::size_t>(c)];
      if (!is_mark(other) && std::abs(other - value) <= kMaxStepM) return true;
    }
  }
  return false;
}

}  // namespace

std::size_t remove_suspects(RasterWindow& window) {
  std::vector<std::size_t> suspects;
  for (int row = 0; row < window.rows; ++row) {
    for (int column = 0; column < window.columns; ++column) {
      const std::size_t n = static_cast<std::size_t>(row) * static_cast<std::size_t>(window.columns) +
                            static_cast<std::size_t>(column);
      const float depth = window.depths_m[n];
      const bool impossible = depth > kDeepestM || depth < -kHighestM;
      if (is_mark(depth) ? !has_believable_neighbour(window, row, column) : impossible) suspects.push_back(n);
    }
  }
  for (const std::size_t n : suspects) window.depths_m[n] = std::numeric_limits<float>::quiet_NaN();
  return suspects.size();
}

}  // namespace halocline::bathymetry
