#include "bathymetry/terrain/ray_trace.h"

#include <algorithm>
#include <cmath>

namespace halocline::bathymetry {
namespace {

constexpr double kTinyDirection = 1e-20;
// A block is leapt over only when the ray clears it by this: far above the rounding of the ray's depth (1e-12
// m), far below what anyone measures.
constexpr double kBlockSlackM = 1e-9;

// The tiny component points into the grid, so that a ray along the grid's edge stays inside.
double away_from_zero(double component, double position, int cells) {
  if (std::abs(component) >= kTinyDirection) return component;
  return position < 0.5 * cells ? kTinyDirection : -kTinyDirection;
}

// The cell along one axis that holds parameter t: floor finds it but for rounding, the crossings decide.
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

// The smallest root in (0, length] of a + b s + c s^2 with a > 0, or a negative number when there is none.
double first_root(double a, double b, double c, double length) {
  constexpr double kNone = -1;
  const bool below_at_end = a + (b + c * length) * length <= 0;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return below_at_end ? length : kNone;
  const double root = std::sqrt(discriminant);
  // The pair q / c, a / q loses no digits to cancellation; the sign of b decides which is the first positive
  // one.
  double s = kNone;
  if (b < 0) {
    s = a / (-0.5 * (b - root));
  } else if (c < 0) {
    s = -0.5 * (b + root) / c;
  }
  if (below_at_end) return s >= 0 ? std::min(s, length) : length;
  return s <= length ? s : kNone;
}

// The walk over blocks: block (bi, bj) of `level` holds parameter t.
class Walk {
 public:
  Walk(const HeightGrid& grid, const ShallowestPyramid& pyramid, const GridRay& ray, Interval interval)
      : grid_(grid),
        pyramid_(pyramid),
        ray_(ray),
        t_(interval.begin_m),
        end_(interval.end_m),
        forward_x_(ray.direction_x > 0),
        forward_y_(ray.direction_y > 0) {
    const GridGeometry& g = grid.geometry();
    level_ = std::min(kStartLevel, pyramid.top_level());
    bi_ = start_cell(ray.origin_x + ray.direction_x * t_, g.cells_x(), forward_x_, t_,
                     [&](int n) { return ray.crossing_x(n); }) >>
          level_;
    bj_ = start_cell(ray.origin_y + ray.direction_y * t_, g.cells_y(), forward_y_, t_,
                     [&](int n) { return ray.crossing_y(n); }) >>
          level_;
  }

  TraceResult run() {
    for (;;) {
      const double exit_x = ray_.crossing_x((bi_ + forward_x_) << level_);
      const double exit_y = ray_.crossing_y((bj_ + forward_y_) << level_);
      const double exit = std::min(std::min(exit_x, exit_y), end_);
      if (level_ > 0) {
        const double deepest = ray_.origin_z_m + ray_.direction_z * (ray_.direction_z > 0 ? exit : t_);
        if (deepest + kBlockSlackM >= pyramid_.shallowest(level_, bi_, bj_)) {
          descend();
          continue;
        }
      } else if (const TraceResult result = enter_cell(exit); result.end != TraceEnd::kPassed) {
        return result;
      }
      if (exit >= end_) return {};
      t_ = std::max(t_, exit);
      advance(exit_x <= exit_y);
    }
  }

 private:
  // To the block across the boundary just reached; up a level whenever that boundary is also the parent's.
  void advance(bool across_x) {
    int& block = across_x ? bi_ : bj_;
    const bool forward = across_x ? forward_x_ : forward_y_;
    const bool leaves_parent = (block & 1) == (forward ? 1 : 0);
    block += forward ? 1 : -1;
    if (leaves_parent && level_ < pyramid_.top_level()) {
      ++level_;
      bi_ >>= 1;
      bj_ >>= 1;
    }
  }

  // To the quarter of the block that holds t: on the far side of the middle line once t has reached its
  // crossing.
  void descend() {
    --level_;
    bi_ = 2 * bi_ + 1;
    bj_ = 2 * bj_ + 1;
    const bool beyond_x = t_ >= ray_.crossing_x(bi_ << level_);
    const bool beyond_y = t_ >= ray_.crossing_y(bj_ << level_);
    bi_ -= beyond_x != forward_x_;
    bj_ -= beyond_y != forward_y_;
  }

  TraceResult enter_cell(double exit) const {
    const BilinearCell cell = grid_.cell(bi_, bj_);
    const double u = std::clamp(ray_.origin_x + ray_.direction_x * t_ - bi_, 0.0, 1.0);
    const double v = std::clamp(ray_.origin_y + ray_.direction_y * t_ - bj_, 0.0, 1.0);
    const double du = ray_.direction_x, dv = ray_.direction_y;
    // Bottom minus ray along the ray: f(s) = a + b s + c s^2, s from the entry into the cell.
    const double a = cell.depth(u, v) - (ray_.origin_z_m + ray_.direction_z * t_);
    if (is_no_data(cell)) return {TraceEnd::kNoData, t_, {bi_, bj_, u, v}};
    if (a <= 0) return {TraceEnd::kHit, t_, {bi_, bj_, u, v}};
    const double b = cell.slope_u(v) * du + cell.slope_v(u) * dv - ray_.direction_z;
    const double s = first_root(a, b, cell.c * du * dv, exit - t_);
    if (s < 0) return {};
    return {TraceEnd::kHit,
            t_ + s,
            {bi_, bj_, std::clamp(u + du * s, 0.0, 1.0), std::clamp(v + dv * s, 0.0, 1.0)}};
  }

  const HeightGrid& grid_;
  const ShallowestPyramid& pyramid_;
  const GridRay& ray_;
  double t_, end_;
  bool forward_x_, forward_y_;
  int level_ = 0, bi_ = 0, bj_ = 0;
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

TraceResult trace_grid(const HeightGrid& grid, const ShallowestPyramid& pyramid, const GridRay& ray,
                       Interval interval) {
  const double deepest =
      ray.origin_z_m + ray.direction_z * (ray.direction_z > 0 ? interval.end_m : interval.begin_m);
  if (deepest + kBlockSlackM < pyramid.shallowest_of_all()) return {};
  return Walk(grid, pyramid, ray, interval).run();
}

}  // namespace halocline::bathymetry
