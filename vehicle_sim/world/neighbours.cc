// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/world/neighbours.h"

#include <algorithm>
#include <cmath>

namespace halocline::vehicle_sim {
namespace {

constexpr double kMargin = 4;  // m: relative movement of two fast vehicles in about a second

struct Placed {
  double column_x, column_y;  // whole numbers
  std::size_t index;
};

bool before(const Placed& a, const Placed& b) {
  if (a.column_x != b.column_x) return a.column_x < b.column_x;
  if (a.column_y != b.column_y) return a.column_y < b.column_y;
  return a.index < b.index;
}

std::vector<Placed> in_columns(const std::vector<Vec3>& positions, double width) {
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < positions.size(); ++i)
    placed.push_back({std::floor(positions[i].x() / width), std::floor(positions[i].y() / width), i});
  std::sort(placed.begin(), placed.end(), before);
  return placed;
}

}  // namespace

const std::vector<Neighbours::Pair>& Neighbours::within(double reach_m, const std::vector<Vec3>& positions) {
  if (!still_holds(reach_m, positions)) rebuild(reach_m, positions);
  return pairs_;
}

bool Neighbours::still_holds(double reach_m, const std::vector<Vec3>& positions) const {
  if (reach_m > reach_m_ || positions.size() != made_at_.size()) return false;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if ((positions[i] - made_at_[i]).squaredNorm() > kMargin * kMargin / 4) return false;
  }
  return true;
}

void Neighbours::rebuild(double reach_m, const std::vector<Vec3>& positions) {
  reach_m_ = reach_m;
  made_at_ = positions;
  pairs_.clear();
  const double width = reach_m + kMargin;
  const std::vector<Placed> placed = in_columns(positions, width);
  for (const Placed& one : placed) {
    for (int dx = -1; dx <= 1; ++dx) {
      const Placed low{one.column_x + dx, one.column_y - 1, 0};
      auto other = std::lower_bound(placed.begin(), placed.end(), low, before);
      for (; other != placed.end() && other->column_x == low.column_x && other->column_y <= one.column_y + 1;
           ++other) {
        const bool is_near = (positions[one.index] - positions[other->index]).squaredNorm() <= width * width;
        if (one.index < other->index && is_near) pairs_.emplace_back(one.index, other->index);
      }
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
}

}  // namespace halocline::vehicle_sim
