// SPDX-License-Identifier: BSD-3-Clause
// Search for pairs of vehicles that may be near each other, before contacts are computed.
//
// Model: a list of pairs with a margin for their movement (Verlet 1967), rebuilt from columns of cells when
// any vehicle has moved by half the margin. The list holds every pair within reach and few others, in the
// order of their indices, so the contacts found do not depend on when it was rebuilt. Cost: N for each step,
// N log N every few hundred steps; many vehicles above one another in one column cost the square of their
// number then.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/frames.h"

namespace halocline::vehicle_sim {

class Neighbours {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;  // first < second

  // Returns all pairs whose distance is at most `reach_m` (above 0), and some beyond, in ascending order.
  // Positions must be finite.
  const std::vector<Pair>& within(double reach_m, const std::vector<Vec3>& positions);

 private:
  bool still_holds(double reach_m, const std::vector<Vec3>& positions) const;
  void rebuild(double reach_m, const std::vector<Vec3>& positions);

  double reach_m_ = 0;
  std::vector<Vec3> made_at_;  // positions at the last rebuild
  std::vector<Pair> pairs_;
};

}  // namespace halocline::vehicle_sim
