// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/endless_bottom.h"

#include <algorithm>
#include <cmath>

namespace halocline::bathymetry {
namespace {

// Returns the cell along one axis that contains parameter t. floor finds it up to rounding; the crossings
// decide.
template <typename Crossing>
int cell_at(double position, bool forward, double t, const Crossing& crossing) {
  constexpr double kMax = EndlessBottom::kMaxCells;
  int n = static_cast<int>(std::clamp(std::floor(position), -kMax, kMax));
  const int near = forward ? 0 : 1;  // index of the boundary by which the ray enters a cell
  while (t < crossing(n + near)) n -= forward ? 1 : -1;
  while (t >= crossing(n + 1 - near)) n += forward ? 1 : -1;
  return n;
}

}  // namespace

std::optional<CellPosition> EndlessBottom::locate(double x_m, double y_m) const {
  const double gx = (x_m - geometry_.first_x_m) / geometry_.spacing_m;
  const double gy = (y_m - geometry_.first_y_m) / geometry_.spacing_m;
  if (!(std::abs(gx) < kMaxCells && std::abs(gy) < kMaxCells)) return std::nullopt;
  const double i = std::floor(gx), j = std::floor(gy);
  return CellPosition{static_cast<int>(i), static_cast<int>(j), gx - i, gy - j};
}

BilinearCell EndlessBottom::cell(int i, int j) const {
  const double z00 = post(i, j), z01 = post(i, j + 1), z10 = post(i + 1, j), z11 = post(i + 1, j + 1);
  return {z00, z10 - z00, z01 - z00, (z00 - z10) + (z11 - z01)};
}

TraceResult EndlessBottom::trace(const GridRay& ray, Interval interval) const {
  if (interval.empty()) return {};
  const bool forward_x = ray.direction_x > 0, forward_y = ray.direction_y > 0;
  double t = interval.begin_m;
  int i = cell_at(ray.origin_x + ray.direction_x * t, forward_x, t, [&](int n) { return ray.crossing_x(n); });
  int j = cell_at(ray.origin_y + ray.direction_y * t, forward_y, t, [&](int n) { return ray.crossing_y(n); });
  while (std::abs(i) < kMaxCells && std::abs(j) < kMaxCells) {
    const double exit_x = ray.crossing_x(i + (forward_x ? 1 : 0));
    const double exit_y = ray.crossing_y(j + (forward_y ? 1 : 0));
    const double exit = std::min({exit_x, exit_y, interval.end_m});
    const TraceResult result = trace_cell(cell(i, j), ray, i, j, {t, exit});
    if (result.end != TraceEnd::kPassed || exit >= interval.end_m) return result;
    t = std::max(t, exit);
    (exit_x <= exit_y ? i : j) += (exit_x <= exit_y ? forward_x : forward_y) ? 1 : -1;
  }
  return {};
}

}  // namespace halocline::bathymetry
