// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/ray_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

// Slope at point i of the parabola through it and its two neighbours; at an end that of the parabola through
// the first or last three points. Two points give the slope of the line.
template <class Value>
double parabola_slope(const std::vector<double>& x, std::size_t i, const Value& f) {
  const auto difference = [&](std::size_t k) { return (f(k + 1) - f(k)) / (x[k + 1] - x[k]); };
  if (x.size() < 2) return 0;
  if (x.size() == 2) return difference(0);
  const std::size_t middle = std::clamp<std::size_t>(i, 1, x.size() - 2);
  const double before = difference(middle - 1), after = difference(middle);
  const double bend = (after - before) / (x[middle + 1] - x[middle - 1]);
  return before + bend * (2 * x[i] - x[middle - 1] - x[middle]);
}

double minmod(double a, double b) { return a * b <= 0 ? 0 : std::abs(a) < std::abs(b) ? a : b; }

// The slope of the parabola, limited after Huynh 1993, equation (2.17) (M3-A): there is no overshoot next to
// a sharp bend or in water of constant speed, and smooth water keeps the slope of the parabola, also at
// extrema.
template <class Value>
double limited_slope(const std::vector<double>& x, std::size_t i, const Value& f) {
  const std::size_t last = x.size() - 1;
  const auto difference = [&](std::size_t k) { return (f(k + 1) - f(k)) / (x[k + 1] - x[k]); };
  const auto bend = [&](std::size_t k) {
    const std::size_t m = std::clamp<std::size_t>(k, 1, last - 1);
    return (difference(m) - difference(m - 1)) / (x[m + 1] - x[m - 1]);
  };
  const double slope = parabola_slope(x, i, f);
  if (last < 2) return slope;
  const double before = difference(i > 0 ? i - 1 : 0), after = difference(std::min(i, last - 1));
  if (i == 0 || i == last) return minmod(slope, 3 * before);
  const double from_left = before + minmod(bend(i - 1), bend(i)) * (x[i] - x[i - 1]),
               from_right = after - minmod(bend(i), bend(i + 1)) * (x[i + 1] - x[i]);
  const double either = minmod(from_left, from_right);
  const double most = std::max(3 * std::abs(minmod(before, after)), 1.5 * std::abs(either));
  return minmod(slope, std::copysign(most, either));
}

// Coefficients of the cubic a + b t + c t^2 + d t^3 over t = 0..1, from values and slopes at its ends.
std::array<double, 4> cubic(double f0, double s0, double f1, double s1) {
  return {f0, s0, 3 * (f1 - f0) - 2 * s0 - s1, 2 * (f0 - f1) + s0 + s1};
}

// Value, first and second derivative of a cubic.
struct Derivatives {
  double value, first, second;
};
Derivatives derivatives(const std::array<double, 4>& a, double t) {
  return {a[0] + t * (a[1] + t * (a[2] + t * a[3])), a[1] + t * (2 * a[2] + t * 3 * a[3]),
          2 * a[2] + t * 6 * a[3]};
}

}  // namespace

LocalSpeed SpeedPatch::at(double range_m, double depth_m) const {
  const double u = (range_m - range_) * per_width_, v = (depth_m - depth_) * per_height_;
  std::array<double, 4> values{}, slopes{}, bends{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Derivatives row = derivatives(a_[i], v);
    values[i] = row.value;
    slopes[i] = row.first;
    bends[i] = row.second;
  }
  const Derivatives c = derivatives(values, u), down = derivatives(slopes, u);
  const double down_down = bends[0] + u * (bends[1] + u * (bends[2] + u * bends[3]));
  return {c.value,
          c.first * per_width_,
          down.value * per_height_,
          c.second * per_width_ * per_width_,
          down.first * per_width_ * per_height_,
          down_down * per_height_ * per_height_};
}

RaySection::RaySection(std::vector<double> ranges_m, std::vector<RayWater> columns)
    : ranges_(std::move(ranges_m)), columns_(std::move(columns)) {
  require(!columns_.empty() && ranges_.size() == columns_.size() && ranges_.front() == 0,
          "a section needs a range for each of its columns, the first of them 0");
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    require(i == 0 || ranges_[i] > ranges_[i - 1], "the ranges of a section do not rise");
    require(columns_[i].depths_m() == depths_m(), "the columns of a section have different knots");
  }
  const std::size_t knots = depths_m().size();
  nodes_.resize(columns_.size() * knots);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    for (std::size_t j = 0; j < knots; ++j) {
      const auto along = [&](std::size_t k) { return columns_[k].speeds_mps()[j]; };
      const auto down = [&](std::size_t k) { return columns_[i].speeds_mps()[k]; };
      nodes_[i * knots + j] = {down(j), parabola_slope(ranges_, i, along), limited_slope(depths_m(), j, down),
                               0};
    }
    for (std::size_t j = 0; j < knots; ++j) {
      const auto along = [&](std::size_t k) { return nodes_[i * knots + k].along; };
      nodes_[i * knots + j].along_down = parabola_slope(depths_m(), j, along);
    }
  }
}

SectionCell RaySection::cell_at(double range_m, double depth_m, bool rises) const {
  const auto after = std::upper_bound(ranges_.begin() + 1, ranges_.end(), range_m);
  std::size_t layer = columns_.front().layer_at(depth_m);
  if (rises && layer > 0 && depth_m == depths_m()[layer]) --layer;
  return {static_cast<std::size_t>(after - ranges_.begin() - 1), layer};
}

double RaySection::end_of(std::size_t strip) const {
  return strip + 1 < ranges_.size() ? ranges_[strip + 1] : std::numeric_limits<double>::infinity();
}

SpeedPatch RaySection::patch(const SectionCell& cell) const {
  const bool is_last = cell.strip + 1 == ranges_.size();
  const double width = is_last ? 1 : ranges_[cell.strip + 1] - ranges_[cell.strip];
  const double height = depths_m()[cell.layer + 1] - depths_m()[cell.layer];
  SpeedPatch patch;
  patch.range_ = ranges_[cell.strip];
  patch.depth_ = depths_m()[cell.layer];
  patch.per_width_ = 1 / width;
  patch.per_height_ = 1 / height;
  // Cubics along range of c and of c_z at the depths of the corners; they are then combined by cubics over
  // depth.
  const auto along = [&](std::size_t knot) {
    const Node &a = node(cell.strip, knot), &b = is_last ? a : node(cell.strip + 1, knot);
    return is_last ? std::pair{cubic(a.c, 0, a.c, 0), cubic(a.down, 0, a.down, 0)}
                   : std::pair{cubic(a.c, a.along * width, b.c, b.along * width),
                               cubic(a.down, a.along_down * width, b.down, b.along_down * width)};
  };
  const auto [c_above, down_above] = along(cell.layer);
  const auto [c_below, down_below] = along(cell.layer + 1);
  for (std::size_t i = 0; i < 4; ++i)
    patch.a_[i] = cubic(c_above[i], down_above[i] * height, c_below[i], down_below[i] * height);
  return patch;
}

double RaySection::absorption_db_per_m(const SectionCell& cell, double range_m, double depth_m) const {
  const double top = depths_m()[cell.layer], u = (depth_m - top) / (depths_m()[cell.layer + 1] - top);
  const auto of_column = [&](std::size_t column) {
    const LayerAbsorption& layer = columns_[column].absorption()[cell.layer];
    return layer.a0 + u * (layer.a1 + u * layer.a2);
  };
  const double here = of_column(cell.strip);
  if (cell.strip + 1 == columns_.size()) return here;
  const double share = (range_m - ranges_[cell.strip]) / (ranges_[cell.strip + 1] - ranges_[cell.strip]);
  return here + share * (of_column(cell.strip + 1) - here);
}

double RaySection::speed_at(double range_m, double depth_m) const {
  return patch(cell_at(range_m, depth_m)).at(range_m, depth_m).c;
}

}  // namespace halocline::acoustics
