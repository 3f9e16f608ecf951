// SPDX-License-Identifier: BSD-3-Clause
// Which of many vehicles may be near each other: the cheap first look before contacts are searched.
//
// Model: a list of pairs with a margin of their movement (Verlet 1967), made anew from columns of cells when
// any vehicle has moved by half the margin. A list holds every pair that is within reach and few others,
// ordered by their indices, so what is found does not depend on when it was made. Cost: N a step, N log N
// each few hundred steps; many vehicles above one another in one column cost their number squared then.
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

  // All pairs whose distance is at most `reach_m` (above 0), and some beyond; in ascending order. Positions
  // finite.
  const std::vector<Pair>& within(double reach_m, const std::vector<Vec3>& positions);

 private:
  bool still_holds(double reach_m, const std::vector<Vec3>& positions) const;
  void rebuild(double reach_m, const std::vector<Vec3>& positions);

  double reach_m_ = 0;
  std::vector<Vec3> made_at_;  // positions when the list was made
  std::vector<Pair> pairs_;
};

}  // namespace halocline::vehicle_sim
