#include "bathymetry/terrain/profile.h"

#include <algorithm>
#include <cmath>

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

// Distances at which the line crosses the grid's lines of one axis, inside (0, length).
void append_crossings(double from, double direction, double length, double first, double spacing, int lines,
                      std::vector<double>& out) {
  if (direction == 0) return;
  const double a = (from - first) / spacing, b = a + direction / spacing * length;
  const auto line_index = [&](double g) { return static_cast<int>(std::clamp(g, -1.0, lines + 1.0)); };
  const int lowest = std::max(0, line_index(std::floor(std::min(a, b))));
  const int highest = std::min(lines - 1, line_index(std::ceil(std::max(a, b))));
  for (int n = lowest; n <= highest; ++n) {
    const double distance = (first + n * spacing - from) / direction;
    if (distance > 0 && distance < length) out.push_back(distance);
  }
}

std::vector<double> all_crossings(const Terrain& terrain, const Line& line) {
  std::vector<double> out{0};
  for (std::size_t n = 0; n < terrain.grid_count(); ++n) {
    const GridGeometry& g = terrain.grid(n).geometry();
    append_crossings(line.from.x_m, line.north, line.length_m, g.first_x_m, g.spacing_m, g.posts_x, out);
    append_crossings(line.from.y_m, line.east, line.length_m, g.first_y_m, g.spacing_m, g.posts_y, out);
  }
  out.push_back(line.length_m);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

// The piece of the line between two neighbouring crossings: it lies in one cell, that of its middle.
struct Piece {
  DepthStatus status = DepthStatus::kOutside;
  double begin_m = 0, end_m = 0;
  double z = 0, slope = 0, curvature = 0;  // z + slope s + curvature s^2, s from begin_m

  double depth(double s) const { return z + (slope + curvature * s) * s; }
};

Piece piece_between(const Terrain& terrain, const Line& line, double begin_m, double end_m) {
  Piece piece{.begin_m = begin_m, .end_m = end_m};
  const PlanePoint middle = line.at(0.5 * (begin_m + end_m));
  const int index = terrain.grid_index_at(middle.x_m, middle.y_m);
  if (index < 0) return piece;
  const HeightGrid& grid = terrain.grid(static_cast<std::size_t>(index));
  const CellPosition at = *grid.locate(middle.x_m, middle.y_m);
  const BilinearCell cell = grid.cell(at.i, at.j);
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

// A gap is written once, from its first to its last point.
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

}  // namespace

std::vector<ProfilePoint> uniform_profile(const Terrain& terrain, PlanePoint from, PlanePoint to,
                                          std::size_t count) {
  require(count >= 2, "a uniform profile needs at least 2 samples");
  const Line line = line_between(from, to);
  std::vector<ProfilePoint> points(count);
  const double step = line.length_m / static_cast<double>(count - 1);
  const double step_x = (to.x_m - from.x_m) / static_cast<double>(count - 1);
  const double step_y = (to.y_m - from.y_m) / static_cast<double>(count - 1);
  for (std::size_t k = 0; k < count; ++k) {
    // The last sample is `to` itself, bit by bit.
    const auto n = static_cast<double>(k);
    const bool last = k + 1 == count;
    const DepthSample sample =
        terrain.depth_at(last ? to.x_m : from.x_m + n * step_x, last ? to.y_m : from.y_m + n * step_y);
    points[k] = {n * step, sample.z_m, sample.status};
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
