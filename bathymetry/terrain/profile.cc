// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "bathymetry/terrain/height_grid.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::bathymetry {
namespace {

struct Line {
  PlanePoint from;
  double length_m, north, east;  // unit direction

  PlanePoint at(double distance_m) const {
    return {from.x_m + north * distance_m, from.y_m + east * distance_m};
  }
};

Line line_between(PlanePoint from, PlanePoint to) {
  const double length = elementary::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  return {from, length, length > 0 ? (to.x_m - from.x_m) / length : 0,
          length > 0 ? (to.y_m - from.y_m) / length : 0};
}

bool is_finite(const Line& line) {
  return std::isfinite(line.from.x_m) && std::isfinite(line.from.y_m) && std::isfinite(line.length_m);
}

// Limit of the lines of an endless grid that are considered on either side; the line beyond them counts as
// one piece.
constexpr int kMaxLinesBeyond = 1 << 20;

// Appends the distances at which the line crosses the grid's lines of one axis, inside (0, length).
void append_crossings(double from, double direction, double length, double first, double spacing, int lines,
                      int lines_beyond, std::vector<double>& out) {
  if (direction == 0) return;
  const double a = (from - first) / spacing, b = a + direction / spacing * length;
  const double least = -lines_beyond, most = lines - 1 + lines_beyond;
  const auto line_index = [&](double g) { return static_cast<int>(std::clamp(g, least - 1, most + 1)); };
  const int lowest = std::max(-lines_beyond, line_index(std::floor(std::min(a, b))));
  const int highest = std::min(lines - 1 + lines_beyond, line_index(std::ceil(std::max(a, b))));
  for (int n = lowest; n <= highest; ++n) {
    const double distance = (first + n * spacing - from) / direction;
    if (distance > 0 && distance < length) out.push_back(distance);
  }
}

std::vector<double> all_crossings(const Terrain& terrain, const Line& line) {
  std::vector<double> out{0};
  for (std::size_t n = 0; n < terrain.grid_count(); ++n) {
    const GridGeometry& g = terrain.grid(n).geometry();
    const int beyond = n == 0 && terrain.is_endless() ? kMaxLinesBeyond : 0;
    append_crossings(line.from.x_m, line.north, line.length_m, g.first_x_m, g.spacing_m, g.posts_x, beyond,
                     out);
    append_crossings(line.from.y_m, line.east, line.length_m, g.first_y_m, g.spacing_m, g.posts_y, beyond,
                     out);
  }
  out.push_back(line.length_m);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

// Piece of the line between two neighbouring crossings; it lies in the cell of its middle.
struct Piece {
  DepthStatus status = DepthStatus::kOutside;
  double begin_m = 0, end_m = 0;
  double z = 0, slope = 0, curvature = 0;  // depth z + slope s + curvature s^2, s from begin_m

  double depth(double s) const { return z + (slope + curvature * s) * s; }
};

Piece piece_between(const Terrain& terrain, const Line& line, double begin_m, double end_m) {
  Piece piece{.begin_m = begin_m, .end_m = end_m};
  const PlanePoint middle = line.at(0.5 * (begin_m + end_m));
  const int index = terrain.grid_index_at(middle.x_m, middle.y_m);
  const HeightGrid& grid = terrain.grid(static_cast<std::size_t>(std::max(index, 0)));
  const auto beyond = index < 0 ? terrain.cell_beyond(middle.x_m, middle.y_m) : std::nullopt;
  if (index < 0 && !beyond) return piece;
  const CellPosition at = beyond ? beyond->second : *grid.locate(middle.x_m, middle.y_m);
  const BilinearCell cell = beyond ? beyond->first : grid.cell(at.i, at.j);
  piece.status = is_no_data(cell) ? DepthStatus::kNoData : DepthStatus::kOk;
  const double du = line.north / grid.geometry().spacing_m, dv = line.east / grid.geometry().spacing_m;
  const double half = 0.5 * (end_m - begin_m);
  const double u = std::clamp(at.u - du * half, 0.0, 1.0), v = std::clamp(at.v - dv * half, 0.0, 1.0);
  piece.z = cell.depth(u, v);
  piece.slope = cell.slope_u(v) * du + cell.slope_v(u) * dv;
  piece.curvature = cell.c * du * dv;
  return piece;
}

void append_point(std::vector<ProfilePoint>& points, double distance_m, double z_m, DepthStatus status) {
  const bool same_place =
      !points.empty() && points.back().distance_m == distance_m && points.back().status == status;
  if (!same_place) points.push_back({distance_m, status == DepthStatus::kOk ? z_m : kUnknown, status});
}

// Appends the points of a piece. A gap is written once, from its first to its last point.
void append_piece(std::vector<ProfilePoint>& points, const Piece& piece) {
  const double length = piece.end_m - piece.begin_m;
  if (piece.status != DepthStatus::kOk && points.size() > 1 && points.back().status == piece.status &&
      points[points.size() - 2].status == piece.status) {
    points.back().distance_m = piece.end_m;
    return;
  }
  append_point(points, piece.begin_m, piece.z, piece.status);
  const double turn = -piece.slope / (2 * piece.curvature);
  if (piece.status == DepthStatus::kOk && turn > 0 && turn < length) {
    append_point(points, piece.begin_m + turn, piece.depth(turn), piece.status);
  }
  append_point(points, piece.end_m, piece.depth(length), piece.status);
}

// Sampler of a finite line over one grid. It computes what HeightGrid::locate and Terrain::depth_at do, in
// branchless passes over blocks of samples: compilers vectorise the first pass, and all posts of a block are
// prefetched before one is read.
class GridSampler {
 public:
  explicit GridSampler(const HeightGrid& grid) : grid_(grid) {}

  static constexpr std::size_t kBlock = 64;
  // Sets depth and status of the points, at most kBlock, at x_m[..], y_m[..].
  void sample(const double* x_m, const double* y_m, std::span<ProfilePoint> points) {
    locate(x_m, y_m, points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const float* low = grid_.posts().data() + grid_.index(i_[k], j_[k]);
      __builtin_prefetch(low);
      __builtin_prefetch(low + grid_.geometry().posts_y);
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double z = grid_.cell(i_[k], j_[k]).depth(u_[k], v_[k]);  // NaN in a no-data cell
      const DepthStatus over_grid = std::isnan(z) ? DepthStatus::kNoData : DepthStatus::kOk;
      points[k].status = inside_[k] ? over_grid : DepthStatus::kOutside;
      points[k].z_m = points[k].status == DepthStatus::kOk ? z : kUnknown;
    }
  }

 private:
  void locate(const double* x_m, const double* y_m, std::size_t count) {
    const GridGeometry g = grid_.geometry();
    const double cells_x = g.cells_x(), cells_y = g.cells_y();
    for (std::size_t k = 0; k < count; ++k) {
      const double gx = (x_m[k] - g.first_x_m) / g.spacing_m, gy = (y_m[k] - g.first_y_m) / g.spacing_m;
      inside_[k] = gx >= 0 && gy >= 0 && gx <= cells_x && gy <= cells_y;
      const double x = std::clamp(gx, 0.0, cells_x), y = std::clamp(gy, 0.0, cells_y);
      i_[k] = std::min(static_cast<int>(x), g.posts_x - 2);
      j_[k] = std::min(static_cast<int>(y), g.posts_y - 2);
      u_[k] = x - i_[k];
      v_[k] = y - j_[k];
    }
  }

  const HeightGrid& grid_;
  std::array<double, kBlock> u_, v_;
  std::array<int, kBlock> i_, j_;
  std::array<bool, kBlock> inside_;
};

}  // namespace

std::vector<ProfilePoint> uniform_profile(const Terrain& terrain, PlanePoint from, PlanePoint to,
                                          std::size_t count) {
  require(count >= 2, "a uniform profile needs at least 2 samples");
  const Line line = line_between(from, to);
  std::vector<ProfilePoint> points(count);
  const double step = line.length_m / static_cast<double>(count - 1);
  const double step_x = (to.x_m - from.x_m) / static_cast<double>(count - 1);
  const double step_y = (to.y_m - from.y_m) / static_cast<double>(count - 1);
  const bool one_grid = terrain.grid_count() == 1 && is_finite(line);
  GridSampler sampler(terrain.grid(0));
  std::array<double, GridSampler::kBlock> x, y;
  for (std::size_t first = 0; first < count; first += x.size()) {
    const std::span<ProfilePoint> block = std::span(points).subspan(first, std::min(x.size(), count - first));
    for (std::size_t k = 0; k < block.size(); ++k) {
      const auto n = static_cast<double>(first + k);
      block[k].distance_m = n * step;
      x[k] = from.x_m + n * step_x;
      y[k] = from.y_m + n * step_y;
    }
    if (first + block.size() == count) {  // the last sample is `to` itself, bit by bit
      x[block.size() - 1] = to.x_m;
      y[block.size() - 1] = to.y_m;
    }
    if (one_grid) sampler.sample(x.data(), y.data(), block);
    for (std::size_t k = 0; k < block.size(); ++k) {
      const bool is_sampled = one_grid && !(terrain.is_endless() && block[k].status == DepthStatus::kOutside);
      if (is_sampled) continue;
      const DepthSample sample = terrain.depth_at(x[k], y[k]);
      block[k].z_m = sample.z_m;
      block[k].status = sample.status;
    }
  }
  return points;
}

std::vector<ProfilePoint> exact_profile(const Terrain& terrain, PlanePoint from, PlanePoint to) {
  const Line line = line_between(from, to);
  std::vector<ProfilePoint> points;
  if (!is_finite(line)) return {{0, kUnknown, DepthStatus::kBadInput}};
  if (line.length_m == 0) {
    const DepthSample sample = terrain.depth_at(from.x_m, from.y_m);
    return {{0, sample.z_m, sample.status}};
  }
  const std::vector<double> crossings = all_crossings(terrain, line);
  points.reserve(crossings.size() + crossings.size() / 2);
  for (std::size_t n = 0; n + 1 < crossings.size(); ++n) {
    append_piece(points, piece_between(terrain, line, crossings[n], crossings[n + 1]));
  }
  return points;
}

}  // namespace halocline::bathymetry
