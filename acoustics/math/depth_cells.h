// SPDX-License-Identifier: BSD-3-Clause
// Splits an interval of depth at the boundaries of precomputed cells. An integral over the interval is then
// the difference of two running sums plus the two pieces at its ends.
//
// The pieces at the ends are integrated directly, so that a short interval does not suffer from the
// difference of two large sums. Used for travel time and absorption along straight paths.
#pragma once

#include <algorithm>
#include <vector>

namespace halocline::acoustics {

// An interval [from, to] as head + whole cells first_boundary..last_boundary + tail. Unless `crosses`, all of
// it is the head.
struct DepthSpan {
  double head_from_m, head_to_m;
  double tail_from_m, tail_to_m;
  // Indices into the boundaries; equal when no whole cell lies between.
  std::size_t first_boundary, last_boundary;
  bool crosses;  // true when at least one boundary lies strictly inside
};

// Splits [from_m, to_m]. `boundaries_m` rise, at least two;
// boundaries.front() <= from_m <= to_m <= boundaries.back().
inline DepthSpan split_span(const std::vector<double>& boundaries_m, double from_m, double to_m) {
  const auto first = std::upper_bound(boundaries_m.begin(), boundaries_m.end(), from_m);
  if (first == boundaries_m.end() || *first >= to_m) return {from_m, to_m, to_m, to_m, 0, 0, false};
  const auto last = std::lower_bound(first, boundaries_m.end(), to_m) - 1;
  return {from_m,
          *first,
          *last,
          to_m,
          static_cast<std::size_t>(first - boundaries_m.begin()),
          static_cast<std::size_t>(last - boundaries_m.begin()),
          true};
}

}  // namespace halocline::acoustics
