// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/ocean_field.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include "core/check.h"
#include "core/elementary.h"
#include "core/hash.h"
#include "core/units.h"

namespace halocline::ocean {
namespace {

constexpr double kEquatorialRadius = 6'378'137;         // m, WGS 84
constexpr double kEccentricity2 = 6.69437999014e-3;     // square of the eccentricity
constexpr double kDeepest = 12'000;                     // m
constexpr double kNearestPole = to_radians(89);         // greatest latitude of the origin
constexpr double kOutsideRad = to_radians(1.0 / 3600);  // tolerance of the grid's edges, for rounding of axes

void require_rising(const std::vector<double>& axis, double lowest, double highest, std::string_view what,
                    std::string_view unit, double unit_size = 1) {
  require(!axis.empty(), "the axis of " + std::string(what) + " is empty");
  for (std::size_t i = 0; i < axis.size(); ++i) {
    require_in_range(axis[i] / unit_size, lowest, highest, what, unit);
    require(i == 0 || axis[i] > axis[i - 1], "the axis of " + std::string(what) + " does not rise");
  }
}

// One variable on its grid at one time.
struct Layers {
  std::span<float> values;
  std::size_t depths, rows, columns;
  std::size_t horizontal() const { return rows * columns; }
};

// Continues the values of each column above and below them; returns the columns without any value.
std::vector<bool> fill_columns(const Layers& layers) {
  std::vector<bool> is_empty(layers.horizontal(), false);
  const auto value = [&](std::size_t depth, std::size_t column) -> float& {
    return layers.values[depth * layers.horizontal() + column];
  };
  for (std::size_t column = 0; column < layers.horizontal(); ++column) {
    std::size_t first = 0;
    while (first < layers.depths && std::isnan(value(first, column))) ++first;
    is_empty[column] = first == layers.depths;
    if (is_empty[column]) continue;
    for (std::size_t depth = 0; depth < first; ++depth) value(depth, column) = value(first, column);
    for (std::size_t depth = first + 1; depth < layers.depths; ++depth) {
      if (std::isnan(value(depth, column))) value(depth, column) = value(depth - 1, column);
    }
  }
  return is_empty;
}

// Fills each column without values with those of the nearest column, counted in steps along rows and columns
// (breadth-first search). Among equally near columns, the first one found counts; the search starts from all
// columns with values in the order of the file.
void fill_land(const Layers& layers, std::vector<bool> is_empty) {
  std::deque<std::size_t> front;
  for (std::size_t column = 0; column < is_empty.size(); ++column) {
    if (!is_empty[column]) front.push_back(column);
  }
  const auto spread = [&](std::size_t from, std::size_t to) {
    if (!is_empty[to]) return;
    is_empty[to] = false;
    for (std::size_t depth = 0; depth < layers.depths; ++depth)
      layers.values[depth * layers.horizontal() + to] = layers.values[depth * layers.horizontal() + from];
    front.push_back(to);
  };
  while (!front.empty()) {
    const std::size_t at = front.front(), column = at % layers.columns;
    front.pop_front();
    if (column > 0) spread(at, at - 1);
    if (column + 1 < layers.columns) spread(at, at + 1);
    if (at >= layers.columns) spread(at, at - layers.columns);
    if (at + layers.columns < layers.horizontal()) spread(at, at + layers.columns);
  }
}

void fill(std::vector<float>& values, const OceanGrid& grid, std::string_view what) {
  const std::size_t of_time = grid.depths_m.size() * grid.columns();
  for (std::size_t time = 0; time < grid.times_s.size(); ++time) {
    const Layers layers{std::span(values).subspan(time * of_time, of_time), grid.depths_m.size(),
                        grid.latitudes_rad.size(), grid.longitudes_rad.size()};
    std::vector<bool> is_empty = fill_columns(layers);
    const bool has_some = std::find(is_empty.begin(), is_empty.end(), false) != is_empty.end();
    require(has_some, std::string(what) + " has no value at time " + std::to_string(time) + " (from 0)");
    fill_land(layers, std::move(is_empty));
  }
}

void check(const std::vector<float>& values, const OceanGrid& grid, double lowest, double highest,
           std::string_view what, std::string_view unit) {
  if (values.empty()) return;
  require(values.size() == grid.levels() * grid.columns(),
          std::string(what) + " has another number of values than its grid has points");
  for (const float value : values) {
    if (!std::isnan(value)) require_in_range(value, lowest, highest, what, unit);
  }
}

std::vector<WaterRange> extremes_of(const OceanValues& values, const OceanGrid& grid) {
  std::vector<WaterRange> extremes;
  for (std::size_t depth = 0; depth < grid.depths_m.size(); ++depth) {
    const auto over = [&](const std::vector<float>& of) {
      std::pair<double, double> range{std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity()};
      for (std::size_t time = 0; time < grid.times_s.size(); ++time) {
        const auto level =
            std::span(of).subspan((time * grid.depths_m.size() + depth) * grid.columns(), grid.columns());
        const auto [least, greatest] = std::minmax_element(level.begin(), level.end());
        range = {std::min<double>(range.first, *least), std::max<double>(range.second, *greatest)};
      }
      return range;
    };
    const auto [coldest, warmest] = over(values.temperature_degc);
    const auto [freshest, saltiest] = over(values.salinity_psu);
    extremes.push_back({coldest, warmest, freshest, saltiest});
  }
  return extremes;
}

std::uint64_t hash_of(const OceanGrid& grid, const OceanValues& values) {
  std::uint64_t hash = 0;
  const auto add = [&hash](const auto& numbers) {
    const auto bytes = std::as_bytes(std::span(numbers));
    hash = xxh3(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), hash);
  };
  for (const auto* axis : {&grid.times_s, &grid.depths_m, &grid.latitudes_rad, &grid.longitudes_rad})
    add(*axis);
  for (const auto* of : {&values.east_mps, &values.north_mps, &values.temperature_degc, &values.salinity_psu})
    add(*of);
  return hash;
}

std::string_view name_of(bool is_latitude) { return is_latitude ? "latitude" : "longitude"; }

// Requires that the origin lies in the range of an axis. `given` is the angle in the scenario; `turns` is
// what shifts it into the grid's turn, rad.
void require_within(const std::vector<double>& axis, double given, double turns, bool is_latitude) {
  const double value = given + turns;
  if (value >= axis.front() - kOutsideRad && value <= axis.back() + kOutsideRad) return;
  require_in_range(to_degrees(given), to_degrees(axis.front() - turns), to_degrees(axis.back() - turns),
                   std::string(name_of(is_latitude)) + " of the scenario's origin", "deg");
}

}  // namespace

OceanField::OceanField(OceanGrid grid, OceanValues values, const GeodeticOrigin& origin,
                       std::vector<std::string> remarks)
    : grid_(std::move(grid)), values_(std::move(values)), origin_(origin), remarks_(std::move(remarks)) {
  require_rising(grid_.times_s, -1e12, 1e12, "time", "s");
  require_rising(grid_.depths_m, 0, kDeepest, "depth", "m");
  require_rising(grid_.latitudes_rad, -90, 90, "latitude", "deg", to_radians(1));
  require_rising(grid_.longitudes_rad, -720, 720, "longitude", "deg", to_radians(1));
  require(grid_.longitudes_rad.back() - grid_.longitudes_rad.front() < 2 * std::numbers::pi,
          "longitudes go round the earth; allowed is less than a turn");
  require(values_.east_mps.empty() == values_.north_mps.empty() &&
              values_.temperature_degc.empty() == values_.salinity_psu.empty(),
          "allowed are both components of the current or none, temperature with salinity or neither");
  require_in_range(to_degrees(origin_.latitude_rad), -to_degrees(kNearestPole), to_degrees(kNearestPole),
                   "latitude of the scenario's origin", "deg");
  // The origin's longitude is shifted by full turns into the turn of the grid.
  const double middle = (grid_.longitudes_rad.front() + grid_.longitudes_rad.back()) / 2;
  origin_.longitude_rad = middle + std::remainder(origin_.longitude_rad - middle, 2 * std::numbers::pi);
  require_within(grid_.latitudes_rad, origin_.latitude_rad, 0, true);
  require_within(grid_.longitudes_rad, origin.longitude_rad, origin_.longitude_rad - origin.longitude_rad,
                 false);
  check(values_.east_mps, grid_, -10, 10, "eastward current", "m/s");
  check(values_.north_mps, grid_, -10, 10, "northward current", "m/s");
  check(values_.temperature_degc, grid_, -5, 45, "temperature", "degC");
  check(values_.salinity_psu, grid_, 0, 50, "salinity", "psu");
  if (has_current()) {
    fill(values_.east_mps, grid_, "eastward current");
    fill(values_.north_mps, grid_, "northward current");
  }
  if (has_water()) {
    fill(values_.temperature_degc, grid_, "temperature");
    fill(values_.salinity_psu, grid_, "salinity");
    extremes_ = extremes_of(values_, grid_);
  }
  // Radii of curvature of the ellipsoid, with latitude phi:
  //
  //   N = a / (1 - e2 sin^2(phi))^(1/2)
  //   M = a (1 - e2) / (1 - e2 sin^2(phi))^(3/2)
  const double sine = elementary::sin(origin_.latitude_rad), w2 = 1 - kEccentricity2 * sine * sine;
  transverse_radius_m_ = kEquatorialRadius / std::sqrt(w2);
  meridional_radius_m_ = transverse_radius_m_ * (1 - kEccentricity2) / w2;
  hash_ = hash_of(grid_, values_);
}

OceanField::Bracket OceanField::bracket(const std::vector<double>& axis, double value) {
  if (axis.size() == 1 || value <= axis.front()) return {0, 0, 0};
  if (value >= axis.back()) return {axis.size() - 1, axis.size() - 1, 0};
  const auto above = std::upper_bound(axis.begin(), axis.end(), value);
  const auto high = static_cast<std::size_t>(above - axis.begin());
  return {high - 1, high, (value - axis[high - 1]) / (axis[high] - axis[high - 1])};
}

// Inverse transverse Mercator projection to second order in the distance over the earth's radius (Snyder
// 1987, page 63). With phi1 the latitude of the foot of the position on the origin's meridian, x north and y
// east,
//
//   phi1   = phi0 + x / M
//   phi    = phi1 - y^2 tan(phi1) / (2 M N)
//   lambda = lambda0 + y / (N cos(phi1))
OceanField::GeodeticPlace OceanField::geodetic(double north_m, double east_m) const {
  const double foot = origin_.latitude_rad + north_m / meridional_radius_m_;
  const auto [sine, cosine] = elementary::sin_cos(foot);
  const double across = east_m / transverse_radius_m_;
  return {foot - across * east_m / (2 * meridional_radius_m_) * sine / cosine,
          origin_.longitude_rad + across / cosine};
}

bool OceanField::covers(double north_m, double east_m) const {
  const GeodeticPlace place = geodetic(north_m, east_m);
  const auto within = [](const std::vector<double>& axis, double value) {
    return value >= axis.front() - kOutsideRad && value <= axis.back() + kOutsideRad;
  };
  return within(grid_.latitudes_rad, place.latitude_rad) && within(grid_.longitudes_rad, place.longitude_rad);
}

OceanField::Corners OceanField::corners(const GeodeticPlace& place) const {
  const Bracket row = bracket(grid_.latitudes_rad, place.latitude_rad),
                column = bracket(grid_.longitudes_rad, place.longitude_rad);
  const std::size_t columns = grid_.longitudes_rad.size();
  return {{row.low * columns + column.low, row.low * columns + column.high, row.high * columns + column.low,
           row.high * columns + column.high},
          {(1 - row.share) * (1 - column.share), (1 - row.share) * column.share,
           row.share * (1 - column.share), row.share * column.share}};
}

double OceanField::at_level(const std::vector<float>& values, const Corners& corners, const Bracket& time,
                            std::size_t depth) const {
  const auto bilinear = [&](std::size_t instant) {
    const float* level = values.data() + (instant * grid_.depths_m.size() + depth) * grid_.columns();
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += corners.weight[i] * level[corners.at[i]];
    return sum;
  };
  const double before = bilinear(time.low);
  return time.share > 0 ? before + time.share * (bilinear(time.high) - before) : before;
}

double OceanField::at(const std::vector<float>& values, const Corners& corners, const Bracket& time,
                      const Bracket& depth) const {
  const double above = at_level(values, corners, time, depth.low);
  return depth.share > 0 ? above + depth.share * (at_level(values, corners, time, depth.high) - above)
                         : above;
}

// True north lies west of grid north by the meridian convergence
//
//   gamma = (lambda - lambda0) sin(phi)
//
// so grid north = cos(gamma) north + sin(gamma) east, grid east = cos(gamma) east - sin(gamma) north.
Vec3 OceanField::current_ned_mps(const Vec3& place, double time_s) const {
  const GeodeticPlace there = geodetic(place.x(), place.y());
  const Corners about = corners(there);
  const Bracket time = bracket(grid_.times_s, time_s), depth = bracket(grid_.depths_m, place.z());
  const double east = at(values_.east_mps, about, time, depth),
               north = at(values_.north_mps, about, time, depth);
  const auto [sine, cosine] = elementary::sin_cos((there.longitude_rad - origin_.longitude_rad) *
                                                  elementary::sin(there.latitude_rad));
  return {cosine * north + sine * east, cosine * east - sine * north, 0};
}

WaterAtDepth OceanField::water_at(const Vec3& place, double time_s) const {
  const Corners about = corners(geodetic(place.x(), place.y()));
  const Bracket time = bracket(grid_.times_s, time_s), depth = bracket(grid_.depths_m, place.z());
  return {place.z(), at(values_.temperature_degc, about, time, depth),
          at(values_.salinity_psu, about, time, depth)};
}

std::vector<WaterAtDepth> OceanField::column_at(double north_m, double east_m, double time_s) const {
  const Corners about = corners(geodetic(north_m, east_m));
  const Bracket time = bracket(grid_.times_s, time_s);
  std::vector<WaterAtDepth> column;
  column.reserve(grid_.depths_m.size());
  for (std::size_t depth = 0; depth < grid_.depths_m.size(); ++depth) {
    column.push_back({grid_.depths_m[depth], at_level(values_.temperature_degc, about, time, depth),
                      at_level(values_.salinity_psu, about, time, depth)});
  }
  return column;
}

// Water between two levels is a mixture of both.
WaterRange OceanField::extremes_at(double depth_m) const {
  const Bracket depth = bracket(grid_.depths_m, depth_m);
  const WaterRange &a = extremes_[depth.low], &b = extremes_[depth.high];
  return {std::min(a.least_degc, b.least_degc), std::max(a.greatest_degc, b.greatest_degc),
          std::min(a.least_psu, b.least_psu), std::max(a.greatest_psu, b.greatest_psu)};
}

// Cubic Hermite interpolation between points 1 and 2, H apart, at t = 0..1:
//
//   f(t) = h00 f1 + h10 H m1 + h01 f2 + h11 H m2
//   h00 = 1 - 3 t^2 + 2 t^3,  h10 = t - 2 t^2 + t^3,  h01 = 3 t^2 - 2 t^3,  h11 = t^3 - t^2
//   m1 = (d1 H + d2 G) / (G + H),  d1 = (f1 - f0) / G,  d2 = (f2 - f1) / H
//
// G is the distance from point 0 to point 1; m2 is the mirror image. At an end of the axis, m1 = d2.
OceanField::Stencil OceanField::stencil(const std::vector<double>& axis, double value) {
  const auto [low, high, t] = bracket(axis, value);
  if (low == high) return {{low, low, low, low}, {0, 1, 0, 0}};
  const std::size_t before = low > 0 ? low - 1 : low, after = std::min(high + 1, axis.size() - 1);
  const double width = axis[high] - axis[low], t2 = t * t, t3 = t2 * t;
  Stencil stencil{{before, low, high, after}, {0, 1 - 3 * t2 + 2 * t3, 3 * t2 - 2 * t3, 0}};
  // Adds the slope at the point `near` of the cell; `far` is the cell's other point, `beyond` the one beyond
  // `near`.
  const auto add_slope = [&](double weight, std::size_t beyond, std::size_t near, std::size_t far,
                             double gap) {
    const double inner = gap > 0 ? gap / (gap + width) : 1, sign = far > near ? 1 : -1;
    stencil.weight[far] += sign * weight * inner;
    stencil.weight[near] -= sign * weight * inner;
    if (gap == 0) return;
    const double outer = (1 - inner) * width / gap;
    stencil.weight[near] += sign * weight * outer;
    stencil.weight[beyond] -= sign * weight * outer;
  };
  add_slope(t - 2 * t2 + t3, 0, 1, 2, axis[low] - axis[before]);
  add_slope(t3 - t2, 3, 2, 1, axis[after] - axis[high]);
  return stencil;
}

std::vector<WaterAtDepth> OceanField::smooth_column_at(double north_m, double east_m, double time_s) const {
  const GeodeticPlace place = geodetic(north_m, east_m);
  const Stencil rows = stencil(grid_.latitudes_rad, place.latitude_rad),
                columns = stencil(grid_.longitudes_rad, place.longitude_rad);
  const Bracket time = bracket(grid_.times_s, time_s);
  const auto bicubic = [&](const std::vector<float>& values, std::size_t instant, std::size_t depth) {
    const float* level = values.data() + (instant * grid_.depths_m.size() + depth) * grid_.columns();
    double sum = 0, least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const double value = level[rows.at[i] * grid_.longitudes_rad.size() + columns.at[j]];
        sum += rows.weight[i] * columns.weight[j] * value;
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
    return std::clamp(sum, least, most);
  };
  const auto at = [&](const std::vector<float>& values, std::size_t depth) {
    const double before = bicubic(values, time.low, depth);
    return time.share > 0 ? before + time.share * (bicubic(values, time.high, depth) - before) : before;
  };
  std::vector<WaterAtDepth> column;
  column.reserve(grid_.depths_m.size());
  for (std::size_t depth = 0; depth < grid_.depths_m.size(); ++depth) {
    column.push_back(
        {grid_.depths_m[depth], at(values_.temperature_degc, depth), at(values_.salinity_psu, depth)});
  }
  return column;
}

// Latitude and longitude change almost linearly along the line; a crossing is placed where their chord has
// it, with an error of 100 m at most over 100 km.
std::vector<double> OceanField::crossings(const Vec3& from, const Vec3& to) const {
  std::vector<double> shares;
  const auto cross = [&shares](const std::vector<double>& axis, double a, double b) {
    if (a == b) return;
    for (const double line : axis) {
      const double share = (line - a) / (b - a);
      if (share > 0 && share < 1) shares.push_back(share);
    }
  };
  const GeodeticPlace a = geodetic(from.x(), from.y()), b = geodetic(to.x(), to.y());
  cross(grid_.latitudes_rad, a.latitude_rad, b.latitude_rad);
  cross(grid_.longitudes_rad, a.longitude_rad, b.longitude_rad);
  cross(grid_.depths_m, from.z(), to.z());
  std::sort(shares.begin(), shares.end());
  return shares;
}

}  // namespace halocline::ocean
