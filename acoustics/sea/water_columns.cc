// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/water_columns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace halocline::acoustics {
namespace {

constexpr double kThinnestSample = 1.0;  // m, least thickness of a layer
// Greatest thickness of a layer, m, so that no feature between two probes is missed.
constexpr double kTallestSample = 250.0;

// Appends the speeds of all columns at a depth.
void add(double depth, const ColumnSpeed& speed, WaterColumns& columns) {
  columns.depths_m.push_back(depth);
  for (std::size_t i = 0; i < columns.speeds_mps.size(); ++i)
    columns.speeds_mps[i].push_back(speed(i, depth));
}

// Appends knots below the last one down to `to`, by bisection until linear interpolation is within tolerance
// of all columns.
void sample(double to, const ColumnSpeed& speed, double tolerance, WaterColumns& columns) {
  const double from = columns.depths_m.back(), height = to - from;
  const auto off = [&](std::size_t i, double start, double end, double share) {
    const double chord = start + share * (end - start);
    return std::abs(speed(i, from + share * height) - chord);
  };
  const auto fits = [&] {
    for (std::size_t i = 0; i < columns.speeds_mps.size(); ++i) {
      const double start = columns.speeds_mps[i].back(), end = speed(i, to);
      if (std::max({off(i, start, end, 0.25), off(i, start, end, 0.5), off(i, start, end, 0.75)}) > tolerance)
        return false;
    }
    return true;
  };
  if (height <= kThinnestSample || (height <= kTallestSample && fits())) return add(to, speed, columns);
  sample(from + height / 2, speed, tolerance, columns);
  sample(to, speed, tolerance, columns);
}

// True when linear interpolation between two knots is within tolerance of the knots between them.
bool chords_fit(const WaterColumns& columns, std::size_t from, std::size_t to, double tolerance) {
  const std::vector<double>& depths = columns.depths_m;
  return std::all_of(columns.speeds_mps.begin(), columns.speeds_mps.end(),
                     [&](const std::vector<double>& speeds) {
                       const double slope = (speeds[to] - speeds[from]) / (depths[to] - depths[from]);
                       for (std::size_t k = from + 1; k < to; ++k) {
                         const double chord = speeds[from] + slope * (depths[k] - depths[from]);
                         if (std::abs(chord - speeds[k]) > tolerance) return false;
                       }
                       return true;
                     });
}

}  // namespace

WaterColumns sampled(const std::vector<double>& depths_m, std::size_t columns, const ColumnSpeed& speed,
                     double tolerance_mps) {
  WaterColumns result{{}, std::vector<std::vector<double>>(columns)};
  add(depths_m.front(), speed, result);
  for (const double depth : depths_m) {
    if (depth > result.depths_m.back()) sample(depth, speed, tolerance_mps, result);
  }
  return result;
}

WaterColumns thinned(const WaterColumns& columns, double tolerance_mps) {
  const std::size_t last = columns.depths_m.size() - 1;
  WaterColumns kept{{}, std::vector<std::vector<double>>(columns.speeds_mps.size())};
  const auto keep = [&](std::size_t k) {
    kept.depths_m.push_back(columns.depths_m[k]);
    for (std::size_t i = 0; i < columns.speeds_mps.size(); ++i)
      kept.speeds_mps[i].push_back(columns.speeds_mps[i][k]);
  };
  keep(0);
  for (std::size_t from = 0; from < last;) {
    std::size_t to = last;
    while (to > from + 1 && !chords_fit(columns, from, to, tolerance_mps)) --to;
    keep(to);
    from = to;
  }
  return kept;
}

}  // namespace halocline::acoustics
