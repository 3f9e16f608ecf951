// SPDX-License-Identifier: BSD-3-Clause
// Reads ocean fields and water columns from CF netCDF files. Part of the module halocline_ocean_fields.so,
// which only ocean_field_reader.cc loads.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"
#include "ocean/cf_axis.h"
#include "ocean/cf_grid.h"
#include "ocean/cf_time.h"
#include "ocean/netcdf_file.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "ocean/sea_variables.h"

namespace halocline::ocean {
namespace {

constexpr double kMaxValues = 1e8;            // limit for a variable, 0.4 GB
constexpr double kMaxValuesPerByte = 300;     // deflate packs 1032 bytes into one; more was never written
constexpr double kEarthRadius = 6'371'008.8;  // m, mean (IUGG)
constexpr double kTurn = 360;                 // degrees

void require_size(const NetcdfFile& file, const CfGrid& grid) {
  const auto bytes = std::filesystem::file_size(file.path());
  require(grid.points() <= std::min(kMaxValues, kMaxValuesPerByte * static_cast<double>(bytes)),
          file.path() + ": has " + fmt::format("{:.0f}", grid.points()) + " values a variable in " +
              std::to_string(bytes) + " bytes; allowed are 100000000, and 300 a byte: cut out a region");
}

// Returns the times relative to the start, s.
std::vector<double> times_from(const NetcdfFile& file, const CfAxis& axis, const std::string& start_date) {
  const std::string units = axis.name.empty() ? "" : file.text(axis.name, "units");
  const bool is_undated = axis.name.empty() || (axis.values.size() == 1 && start_date.empty());
  if (is_undated) {
    require(start_date.empty(), file.path() + ": has no times; allowed is no start");
    return {0};
  }
  try {
    const CfTimeAxis time = CfTimeAxis::parse(units, file.text(axis.name, "calendar"));
    std::vector<double> times_s;
    for (const double value : axis.values) times_s.push_back(time.seconds_at(value));
    const double first = times_s.front(), last = times_s.back();
    const double start = start_date.empty() ? first : time.seconds_of(start_date);
    require(start >= first && start <= last, "the start is " + start_date + "; allowed is " +
                                                 time.date_of(first) + " to " + time.date_of(last));
    for (double& seconds : times_s) seconds -= start;
    return times_s;
  } catch (const InvalidArgument& error) {
    file.refuse(axis.name, error.what());
  }
}

std::vector<double> in_radians(const std::vector<double>& degrees) {
  std::vector<double> radians;
  for (const double angle : degrees) radians.push_back(to_radians(angle));
  return radians;
}

OceanGrid grid_of(const CfGrid& grid, std::vector<double> times_s) {
  return {std::move(times_s), grid.at(AxisKind::kDepth).values,
          in_radians(grid.at(AxisKind::kLatitude).values), in_radians(grid.at(AxisKind::kLongitude).values)};
}

struct Found {
  std::optional<std::string> east, north;
  std::optional<TemperatureVariable> temperature;
  std::optional<SalinityVariable> salinity;
};

Found find_all(const NetcdfFile& file) {
  const Found found{find_eastward(file), find_northward(file), find_temperature(file), find_salinity(file)};
  require(found.east.has_value() == found.north.has_value(),
          file.path() + ": has one component of the current; allowed are both or none");
  require(found.temperature.has_value() == found.salinity.has_value(),
          file.path() + ": has temperature or salinity alone; allowed are both or none");
  require(
      found.east || found.salinity,
      file.path() + ": has neither currents nor temperature and salinity (known names: docs/scenarios.md)");
  return found;
}

OceanField* read_field(const FieldQuery& query) {
  const NetcdfFile file(query.path);
  const Found found = find_all(file);
  const CfGrid on(file, found.east ? *found.east : found.salinity->variable,
                  to_degrees(query.origin.latitude_rad), to_degrees(query.origin.longitude_rad));
  require_size(file, on);
  OceanGrid grid = grid_of(on, times_from(file, on.at(AxisKind::kTime), query.start_date));
  OceanValues values;
  std::vector<std::string> remarks;
  if (found.east) {
    values.east_mps = read_speed(on, file, *found.east);
    values.north_mps = read_speed(on, file, *found.north);
  }
  if (found.salinity) {
    values.temperature_degc = read_temperature(on, file, *found.temperature);
    values.salinity_psu = read_salinity(on, file, *found.salinity);
    if (found.temperature->is_potential) make_in_situ(grid, values);
    remarks = remarks_on(*found.salinity);
  }
  try {
    return new OceanField(std::move(grid), std::move(values), query.origin, std::move(remarks));
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(query.path + ": " + error.what());
  }
}

// Returns the great-circle distance, m, between positions in degrees by the haversine formula:
//
//   h = sin^2((phi2 - phi1) / 2) + cos(phi1) cos(phi2) sin^2((lambda2 - lambda1) / 2)
//   d = 2 R asin(sqrt(h))
double distance_m(double latitude_a, double longitude_a, double latitude_b, double longitude_b) {
  const double half_lat = to_radians(latitude_b - latitude_a) / 2,
               half_lon = to_radians(longitude_b - longitude_a) / 2;
  const double h = elementary::pow(elementary::sin(half_lat), 2) +
                   elementary::cos(to_radians(latitude_a)) * elementary::cos(to_radians(latitude_b)) *
                       elementary::pow(elementary::sin(half_lon), 2);
  return 2 * kEarthRadius * elementary::asin(std::sqrt(std::min(h, 1.0)));
}

// Keeps the values of an axis within `reach` of `place`, and one more on either side.
void keep_about(CfGrid& grid, AxisKind kind, double place, double reach) {
  const std::vector<double>& values = grid.at(kind).values;
  const auto low = std::lower_bound(values.begin(), values.end(), place - reach);
  const auto high = std::upper_bound(values.begin(), values.end(), place + reach);
  const auto first = low == values.begin() ? low : low - 1, last = high == values.end() ? high : high + 1;
  grid.keep(kind, static_cast<std::size_t>(first - values.begin()), static_cast<std::size_t>(last - first));
}

// Keeps the columns that may be near enough to a position.
void keep_window(CfGrid& grid, double latitude_deg, double longitude_deg) {
  const double reach = to_degrees(kFarthestColumn / kEarthRadius);
  const double nearest_pole = std::min(std::abs(latitude_deg) + reach, 89.0);
  keep_about(grid, AxisKind::kLatitude, latitude_deg, reach);
  keep_about(grid, AxisKind::kLongitude, longitude_deg, reach / elementary::cos(to_radians(nearest_pole)));
}

void keep_time(const NetcdfFile& file, CfGrid& grid, int index) {
  const std::vector<std::size_t>& places = grid.at(AxisKind::kTime).places;
  const auto found = std::find(places.begin(), places.end(), static_cast<std::size_t>(index));
  require(found != places.end(), file.path() + ": has " + std::to_string(places.size()) +
                                     " times; given is number " + std::to_string(index) + " (from 0)");
  grid.keep(AxisKind::kTime, static_cast<std::size_t>(found - places.begin()), 1);
}

// Column of a window that has water and is nearest to a position.
struct Nearest {
  std::size_t column = 0;  // index, row by row
  double latitude_deg = 0, longitude_deg = 0, distance_m = std::numeric_limits<double>::infinity();
};

bool has_water(const OceanValues& values, std::size_t at) {
  return !std::isnan(values.temperature_degc[at]) && !std::isnan(values.salinity_psu[at]);
}

Nearest nearest_water(const CfGrid& grid, const OceanValues& values, double latitude_deg,
                      double longitude_deg) {
  Nearest best;
  std::size_t column = 0;
  const std::size_t columns =
      grid.at(AxisKind::kLatitude).values.size() * grid.at(AxisKind::kLongitude).values.size();
  for (const double latitude : grid.at(AxisKind::kLatitude).values) {
    for (const double longitude : grid.at(AxisKind::kLongitude).values) {
      bool is_wet = false;
      for (std::size_t at = column; at < values.salinity_psu.size(); at += columns)
        is_wet |= has_water(values, at);
      const double away =
          is_wet ? distance_m(latitude_deg, longitude_deg, latitude, longitude) : best.distance_m;
      if (away < best.distance_m) best = {column, latitude, longitude, away};
      ++column;
    }
  }
  return best;
}

// Returns the number of levels down to the deepest value of some columns. Below it water does not change and
// needs no rows.
std::size_t levels_with_water(const OceanGrid& grid, const OceanValues& values,
                              const std::vector<std::size_t>& columns) {
  std::size_t levels = 0;
  for (std::size_t level = 0; level < grid.depths_m.size(); ++level) {
    for (const std::size_t column : columns)
      levels = has_water(values, level * grid.columns() + column) ? level + 1 : levels;
  }
  return levels;
}

// Returns the columns around a position: two by two, or fewer on a line of the grid.
std::vector<std::size_t> columns_about(const OceanGrid& grid, double latitude_rad, double longitude_rad) {
  const auto lines = [](const std::vector<double>& axis, double value) {
    const auto above = std::lower_bound(axis.begin(), axis.end(), value);
    const auto high = static_cast<std::size_t>(std::min(above, axis.end() - 1) - axis.begin());
    const bool is_on_it = high == 0 || axis[high] <= value;
    return is_on_it ? std::vector{high} : std::vector{high - 1, high};
  };
  std::vector<std::size_t> columns;
  for (const std::size_t row : lines(grid.latitudes_rad, latitude_rad)) {
    for (const std::size_t column : lines(grid.longitudes_rad, longitude_rad))
      columns.push_back(row * grid.longitudes_rad.size() + column);
  }
  return columns;
}

OceanValues column_of(const OceanValues& values, std::size_t columns, std::size_t column) {
  OceanValues one;
  for (std::size_t at = column; at < values.salinity_psu.size(); at += columns) {
    one.temperature_degc.push_back(values.temperature_degc[at]);
    one.salinity_psu.push_back(values.salinity_psu[at]);
  }
  return one;
}

bool is_within(const std::vector<double>& axis, double value) {
  return value >= axis.front() && value <= axis.back();
}

// Water of the columns near a position, on their grid.
struct Window {
  OceanGrid grid;
  OceanValues values;
  Nearest nearest;
  double longitude_deg = 0;  // longitude of the position in the turn of the grid
  std::string grid_in_words;
};

// Variables of temperature and salinity, each on the grid of its own file; the two grids must be equal.
class WaterFiles {
 public:
  explicit WaterFiles(const ColumnQuery& query)
      : query_(query),
        warm_(query.temperature_path),
        salty_(query.salinity_path.empty() ? query.temperature_path : query.salinity_path),
        temperature_(required(find_temperature(warm_), warm_, "temperature")),
        salinity_(required(find_salinity(salty_), salty_, "salinity")) {}

  Window window(double latitude_deg, double longitude_deg) const {
    CfGrid warm(warm_, temperature_.variable, latitude_deg, longitude_deg),
        salty(salty_, salinity_.variable, latitude_deg, longitude_deg);
    require(warm.is_as(salty), salty_.path() + ": temperature and salinity are on different grids");
    const std::vector<double> latitudes = warm.at(AxisKind::kLatitude).values,
                              longitudes = warm.at(AxisKind::kLongitude).values;
    const double middle = (longitudes.front() + longitudes.back()) / 2;
    const double in_turn = middle + std::remainder(longitude_deg - middle, kTurn);
    for (CfGrid* one : {&warm, &salty}) {
      keep_time(warm_, *one, query_.time_index);
      keep_window(*one, latitude_deg, in_turn);
    }
    require_size(warm_, warm);
    Window window{grid_of(warm, {0}), read(warm, salty), {}, in_turn, {}};
    if (temperature_.is_potential) make_in_situ(window.grid, window.values);
    window.nearest = nearest_water(warm, window.values, latitude_deg, in_turn);
    window.grid_in_words = fmt::format("{:g} to {:g} N and {:g} to {:g} E", latitudes.front(),
                                       latitudes.back(), longitudes.front(), longitudes.back());
    return window;
  }

 private:
  template <class Variable>
  static Variable required(const std::optional<Variable>& found, const NetcdfFile& file, const char* what) {
    require(found.has_value(),
            file.path() + ": has no variable of " + what + " (known names: docs/scenarios.md)");
    return *found;
  }
  OceanValues read(const CfGrid& warm, const CfGrid& salty) const {
    OceanValues values;
    values.temperature_degc = read_temperature(warm, warm_, temperature_);
    values.salinity_psu = read_salinity(salty, salty_, salinity_);
    return values;
  }

  const ColumnQuery& query_;
  NetcdfFile warm_, salty_;
  TemperatureVariable temperature_;
  SalinityVariable salinity_;
};

// Reduces the window to the nearest column with water, which represents a position beyond the grid or among
// land.
void keep_nearest(Window& window) {
  window.values = column_of(window.values, window.grid.columns(), window.nearest.column);
  window.grid.latitudes_rad = {to_radians(window.nearest.latitude_deg)};
  window.grid.longitudes_rad = {to_radians(window.nearest.longitude_deg)};
}

WaterColumn* read_column(const ColumnQuery& query) {
  Window window = WaterFiles(query).window(to_degrees(query.latitude_rad),
                                           std::remainder(to_degrees(query.longitude_rad), kTurn));
  const Nearest& nearest = window.nearest;
  GeodeticOrigin place{query.latitude_rad, to_radians(window.longitude_deg)};
  std::vector<std::size_t> about = columns_about(window.grid, place.latitude_rad, place.longitude_rad);
  const bool is_inside = is_within(window.grid.latitudes_rad, place.latitude_rad) &&
                         is_within(window.grid.longitudes_rad, place.longitude_rad);
  if (!is_inside || levels_with_water(window.grid, window.values, about) == 0) {
    require(
        nearest.distance_m <= kFarthestColumn,
        fmt::format("{}: no water within 300 km of {:g} N {:g} E; its grid spans {}", query.temperature_path,
                    to_degrees(query.latitude_rad), to_degrees(query.longitude_rad), window.grid_in_words));
    keep_nearest(window);
    place = {window.grid.latitudes_rad.front(), window.grid.longitudes_rad.front()};
    about = {0};
  }
  try {
    const OceanField field(window.grid, window.values, place);
    std::vector<WaterAtDepth> rows = field.column_at(0, 0, 0);
    rows.resize(levels_with_water(window.grid, window.values, about));
    return new WaterColumn{std::move(rows), to_radians(nearest.latitude_deg),
                           to_radians(std::remainder(nearest.longitude_deg, kTurn)), nearest.distance_m};
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(query.temperature_path + ": " + error.what());
  }
}

}  // namespace
}  // namespace halocline::ocean

extern "C" halocline::ocean::OceanFieldReader halocline_read_ocean_field;
extern "C" halocline::ocean::WaterColumnReader halocline_read_water_column;

halocline::ocean::OceanField* halocline_read_ocean_field(const halocline::ocean::FieldQuery& query) {
  return halocline::ocean::read_field(query);
}

halocline::ocean::WaterColumn* halocline_read_water_column(const halocline::ocean::ColumnQuery& query) {
  return halocline::ocean::read_column(query);
}
