// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/grid_trace.h"

#include <algorithm>
#include <cmath>

namespace halocline::bathymetry {
namespace {

constexpr double kTinyDirection = 1e-20;

// Replaces a component near 0 by a tiny one that points into the grid, so that a ray along the grid's edge
// stays inside.
double away_from_zero(double component, double position, int cells) {
  if (std::abs(component) >= kTinyDirection) return component;
  return position < 0.5 * cells ? kTinyDirection : -kTinyDirection;
}

// Returns the cell along one axis that contains parameter t. floor finds it up to rounding; the crossings
// decide.
template <typename Crossing>
int start_cell(double position, int cells, bool forward, double t, Crossing crossing) {
  int n = static_cast<int>(std::clamp(std::floor(position), 0.0, cells - 1.0));
  if (forward) {
    while (n > 0 && t < crossing(n)) --n;
    while (n < cells - 1 && t >= crossing(n + 1)) ++n;
  } else {
    while (n < cells - 1 && t < crossing(n + 1)) ++n;
    while (n > 0 && t >= crossing(n)) --n;
  }
  return n;
}

// Returns the smallest root in (0, length] of a + b s + c s^2 with a > 0; a negative number when there is
// none.
double first_root(double a, double b, double c, double length) {
  constexpr double kNone = -1;
  const bool below_at_end = a + (b + c * length) * length <= 0;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return below_at_end ? length : kNone;
  const double root = std::sqrt(discriminant);
  // The pair of roots q / c and a / q loses no digits to cancellation; the sign of b selects the first
  // positive one.
  double s = kNone;
  if (b < 0) {
    s = a / (-0.5 * (b - root));
  } else if (c < 0) {
    s = -0.5 * (b + root) / c;
  }
  if (below_at_end) return s >= 0 ? std::min(s, length) : length;
  return s <= length ? s : kNone;
}

// True when a + b s + c s^2 stays above the slack for s in [0, length]. A parabola lies below the chord
// between its ends by c length^2 / 4 at most. This test saves the root in most cells.
bool stays_above(double a, double b, double c, double length) {
  const double end = a + (b + c * length) * length;
  return std::min(a, end) - std::max(c, 0.0) * (0.25 * length * length) > kSlackM;
}

// Walk over the blocks of a grid: block `at_` contains parameter t.
class Walk {
 public:
  Walk(const HeightGrid& grid, const ShallowestPyramid& pyramid, const GridRay& ray, Interval interval)
      : grid_(grid),
        pyramid_(pyramid),
        ray_(ray),
        t_(interval.begin_m),
        end_(interval.end_m),
        forward_x_(ray.direction_x > 0),
        forward_y_(ray.direction_y > 0),
        at_(start_block(grid.geometry(), pyramid, ray, t_)) {}

  TraceResult run() {
    for (;;) {
      const double exit_x = ray_.crossing_x((at_.i + forward_x_) << at_.level);
      const double exit_y = ray_.crossing_y((at_.j + forward_y_) << at_.level);
      const double exit = std::min(std::min(exit_x, exit_y), end_);
      if (at_.level > 0) {
        const double deepest = ray_.origin_z_m + ray_.direction_z * (ray_.direction_z > 0 ? exit : t_);
        if (deepest + kSlackM >= pyramid_.shallowest(at_.level, at_.i, at_.j)) {
          descend();
          continue;
        }
      } else if (const TraceResult result =
                     trace_cell(grid_.cell(at_.i, at_.j), ray_, at_.i, at_.j, {t_, exit});
                 result.end != TraceEnd::kPassed) {
        return result;
      }
      if (exit >= end_) return {};
      t_ = std::max(t_, exit);
      advance(exit_x <= exit_y);
    }
  }

 private:
  // Moves to the block across the boundary that was reached, and up a level if that boundary is also the
  // parent's.
  void advance(bool across_x) {
    int& block = across_x ? at_.i : at_.j;
    const bool forward = across_x ? forward_x_ : forward_y_;
    const bool leaves_parent = (block & 1) == (forward ? 1 : 0);
    block += forward ? 1 : -1;
    if (leaves_parent && at_.level < pyramid_.top_level()) {
      ++at_.level;
      at_.i >>= 1;
      at_.j >>= 1;
    }
  }

  // Moves to the quarter of the block that contains t: beyond the middle line once t has reached its
  // crossing.
  void descend() {
    --at_.level;
    at_.i = 2 * at_.i + 1;
    at_.j = 2 * at_.j + 1;
    const bool beyond_x = t_ >= ray_.crossing_x(at_.i << at_.level);
    const bool beyond_y = t_ >= ray_.crossing_y(at_.j << at_.level);
    at_.i -= beyond_x != forward_x_;
    at_.j -= beyond_y != forward_y_;
  }

  const HeightGrid& grid_;
  const ShallowestPyramid& pyramid_;
  const GridRay& ray_;
  double t_, end_;
  bool forward_x_, forward_y_;
  PyramidBlock at_;
};

}  // namespace

GridRay to_grid_ray(const GridGeometry& geometry, const Vec3& origin_ned_m, const Vec3& direction) {
  GridRay ray;
  ray.origin_x = (origin_ned_m.x() - geometry.first_x_m) / geometry.spacing_m;
  ray.origin_y = (origin_ned_m.y() - geometry.first_y_m) / geometry.spacing_m;
  ray.origin_z_m = origin_ned_m.z();
  ray.direction_x = away_from_zero(direction.x() / geometry.spacing_m, ray.origin_x, geometry.cells_x());
  ray.direction_y = away_from_zero(direction.y() / geometry.spacing_m, ray.origin_y, geometry.cells_y());
  ray.direction_z = direction.z();
  return ray;
}

Interval clip_to_cells(const CellBlock& block, const GridRay& ray, Interval interval) {
  const double x_first = ray.crossing_x(block.first_i), x_last = ray.crossing_x(block.last_i);
  const double y_first = ray.crossing_y(block.first_j), y_last = ray.crossing_y(block.last_j);
  return {std::max({interval.begin_m, std::min(x_first, x_last), std::min(y_first, y_last)}),
          std::min({interval.end_m, std::max(x_first, x_last), std::max(y_first, y_last)})};
}

PyramidBlock start_block(const GridGeometry& geometry, const ShallowestPyramid& pyramid, const GridRay& ray,
                         double t) {
  const int level = std::min(kStartLevel, pyramid.top_level());
  const int i = start_cell(ray.origin_x + ray.direction_x * t, geometry.cells_x(), ray.direction_x > 0, t,
                           [&](int n) { return ray.crossing_x(n); });
  const int j = start_cell(ray.origin_y + ray.direction_y * t, geometry.cells_y(), ray.direction_y > 0, t,
                           [&](int n) { return ray.crossing_y(n); });
  return {level, i >> level, j >> level};
}

TraceResult trace_cell(const BilinearCell& cell, const GridRay& ray, int i, int j, Interval interval) {
  const double t = interval.begin_m, length = interval.end_m - t;
  const double u = std::clamp(ray.origin_x + ray.direction_x * t - i, 0.0, 1.0);
  const double v = std::clamp(ray.origin_y + ray.direction_y * t - j, 0.0, 1.0);
  const double du = ray.direction_x, dv = ray.direction_y;
  // Bottom minus ray along the ray, with s from the entry into the cell: f(s) = a + b s + c s^2.
  const double a = cell.depth(u, v) - (ray.origin_z_m + ray.direction_z * t);
  const double b = cell.slope_u(v) * du + cell.slope_v(u) * dv - ray.direction_z;
  const double c = cell.c * du * dv;
  if (stays_above(a, b, c, length)) return {};
  if (is_no_data(cell)) return {TraceEnd::kNoData, t, {i, j, u, v}};
  if (a <= 0) return {TraceEnd::kHit, t, {i, j, u, v}};
  const double s = first_root(a, b, c, length);
  if (s < 0) return {};
  return {TraceEnd::kHit, t + s, {i, j, std::clamp(u + du * s, 0.0, 1.0), std::clamp(v + dv * s, 0.0, 1.0)}};
}

bool clears_grid(const ShallowestPyramid& pyramid, const GridRay& ray, Interval interval) {
  const double deepest =
      ray.origin_z_m + ray.direction_z * (ray.direction_z > 0 ? interval.end_m : interval.begin_m);
  return deepest + kSlackM < pyramid.shallowest_of_all();
}

TraceResult trace_grid(const HeightGrid& grid, const ShallowestPyramid& pyramid, const GridRay& ray,
                       Interval interval) {
  if (clears_grid(pyramid, ray, interval)) return {};
  return Walk(grid, pyramid, ray, interval).run();
}

}  // namespace halocline::bathymetry
