// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/field_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"
#include "ocean/ocean_field.h"

namespace halocline::acoustics {
namespace {

constexpr double kSameSpeed = 1e-6;     // m/s, difference below which columns are equal
constexpr double kMinStrip = 20;        // m, least distance of columns
constexpr double kMaxStrips = 512;      // greatest number of columns along a line
constexpr int kStripsPerCell = 4;       // between two crossings of the grid
constexpr double kDeepestProbe = 5000;  // m, as in ray_water()

// Temperature and salinity of the field at one place, interpolated linearly between its depths.
class FieldColumn {
 public:
  FieldColumn(const Environment& environment, double north_m, double east_m)
      : environment_(&environment),
        rows_(environment.field.ocean->smooth_column_at(north_m, east_m, environment.field.time_s)) {}

  double speed_mps(double depth_m) const {
    const auto [depth, temperature, salinity] = at(depth_m);
    return sound_speed_mps(environment_->profile.model(), temperature, salinity, depth,
                           environment_->latitude_rad) +
           environment_->profile.change_mps(depth);
  }
  double absorption_db_per_km(double depth_m, double khz_squared) const {
    const auto [depth, temperature, salinity] = at(depth_m);
    return absorption_spectrum_in(*environment_,
                                  {.temperature_degc = temperature,
                                   .salinity_psu = salinity,
                                   .depth_m = depth,
                                   .pressure_atm = pressure_atm_absolute(depth, environment_->latitude_rad),
                                   .ph = environment_->ph})
        .db_per_km(khz_squared);
  }

 private:
  ocean::WaterAtDepth at(double depth_m) const {
    const auto below =
        std::upper_bound(rows_.begin(), rows_.end(), depth_m,
                         [](double depth, const ocean::WaterAtDepth& row) { return depth < row.depth_m; });
    if (below == rows_.begin()) return {depth_m, below->temperature_degc, below->salinity_psu};
    const ocean::WaterAtDepth& above = *std::prev(below);
    if (below == rows_.end()) return {depth_m, above.temperature_degc, above.salinity_psu};
    const double share = (depth_m - above.depth_m) / (below->depth_m - above.depth_m);
    return {depth_m, above.temperature_degc + share * (below->temperature_degc - above.temperature_degc),
            above.salinity_psu + share * (below->salinity_psu - above.salinity_psu)};
  }

  const Environment* environment_;
  std::vector<ocean::WaterAtDepth> rows_;
};

// Ranges of the columns along the line, m from the first place.
std::vector<double> ranges_of(const ocean::OceanField& field, const Vec3& from, const Vec3& way) {
  const double length = elementary::hypot(way.x(), way.y());
  const double least = std::max(kMinStrip, length / kMaxStrips);
  std::vector<double> crossed{0};
  for (const double share : field.crossings(from, from + way)) {
    const double range = share * length;
    if (range > crossed.back() + least && range < length - least) crossed.push_back(range);
  }
  if (length > 0) crossed.push_back(length);
  std::vector<double> ranges{0};
  for (std::size_t i = 1; i < crossed.size(); ++i) {
    const double width = crossed[i] - crossed[i - 1];
    const int strips = std::clamp(static_cast<int>(width / least), 1, kStripsPerCell);
    for (int k = 1; k < strips; ++k) ranges.push_back(crossed[i - 1] + width * k / strips);
    ranges.push_back(crossed[i]);
  }
  return ranges;
}

// Depths of the section's knots, m: the field's levels down to the first below `deepest_m`, then steps that
// double; and those of the profile's change.
std::vector<double> knots_of(const ocean::OceanField& field, double deepest_m,
                             const std::vector<SpeedRow>& change) {
  std::vector<double> depths{0};
  for (const double depth : field.grid().depths_m) {
    if (depth > 0) depths.push_back(depth);
    if (depth > deepest_m) break;
  }
  double step = depths.size() > 1 ? depths.back() - depths[depths.size() - 2] : kMinStrip;
  while (depths.back() + 4 * step < kDeepestProbe) {
    step *= 2;
    depths.push_back(depths.back() + step);
  }
  if (depths.back() < kDeepestProbe) depths.push_back(kDeepestProbe);
  if (change.empty()) return depths;
  for (const SpeedRow& row : change) depths.push_back(row.depth_m);
  std::sort(depths.begin(), depths.end());
  depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
  return depths;
}

// True when all columns have the same sound speed at every depth, within kSameSpeed.
bool are_alike(const std::vector<std::vector<SpeedRow>>& columns) {
  return std::all_of(columns.begin(), columns.end(), [&](const std::vector<SpeedRow>& column) {
    for (std::size_t j = 0; j < column.size(); ++j) {
      if (std::abs(column[j].sound_speed_mps - columns.front()[j].sound_speed_mps) > kSameSpeed) return false;
    }
    return true;
  });
}

}  // namespace

LinkWater water_between(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                        double deepest_m, double frequency_hz, double tolerance_mps) {
  ensure(bool(environment.field), "water between places of a sea without a field");
  const Vec3 way(to_ned_m.x() - from_ned_m.x(), to_ned_m.y() - from_ned_m.y(), 0);
  const Vec3 start(from_ned_m.x(), from_ned_m.y(), 0);
  const ocean::OceanField& field = *environment.field.ocean;
  std::vector<double> ranges = ranges_of(field, start, way);
  const std::vector<double> depths = knots_of(field, deepest_m, environment.profile.change());
  std::vector<FieldColumn> columns;
  std::vector<std::vector<SpeedRow>> rows;
  for (const double range : ranges) {
    const Vec3 place = start + (range > 0 ? range / ranges.back() : 0) * way;
    columns.emplace_back(environment, place.x(), place.y());
    rows.emplace_back();
    for (const double depth : depths) rows.back().push_back({depth, columns.back().speed_mps(depth)});
  }
  if (are_alike(rows)) {
    return {
        ray_water(environment_at(environment, from_ned_m.x(), from_ned_m.y()), frequency_hz, tolerance_mps),
        nullptr};
  }
  const double khz_squared = hz_to_khz(frequency_hz) * hz_to_khz(frequency_hz);
  std::vector<RayWater> waters;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    waters.emplace_back(std::move(rows[i]), [&](double depth_m) {
      return columns[i].absorption_db_per_km(depth_m, khz_squared);
    });
  }
  auto section = std::make_shared<const RaySection>(std::move(ranges), std::move(waters));
  return {section->columns().front(), section};
}

}  // namespace halocline::acoustics
