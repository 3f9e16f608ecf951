// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/profile_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/csv_table.h"
#include "core/files/input_file.h"
#include "core/units.h"
#include "ocean/ocean_field.h"

namespace halocline::acoustics {
namespace {

// Accepted names of each column: the documented one first, then those of the reference tables.
using Names = std::vector<std::string>;
const Names kDepth = {"depth_m"};
const Names kTemperature = {"temperature_degC", "T_degC", "T90_degC"};
const Names kSalinity = {"salinity_psu", "S_psu", "S_ppt"};
const Names kConservative = {"CT_degC"};
const Names kAbsolute = {"SA_g_per_kg"};
const Names kSpeed = {"sound_speed_mps", "c_m_per_s"};

constexpr const char* kNeeded =
    "a profile needs the columns depth_m, temperature_degC, salinity_psu; or depth_m, CT_degC, SA_g_per_kg; "
    "or depth_m, sound_speed_mps";

// Index of the first column that has one of the names.
std::optional<std::size_t> find_column(const CsvTable& table, const Names& names) {
  for (const std::string& name : names) {
    if (const auto column = table.column(name)) return column;
  }
  return std::nullopt;
}

// Indices of the columns of a profile.
struct Columns {
  std::size_t depth;
  std::size_t first;                  // temperature or sound speed
  std::optional<std::size_t> second;  // salinity; empty for sound speed
  bool teos10 = false;
};

std::optional<Columns> find_columns(const CsvTable& table) {
  const auto depth = find_column(table, kDepth);
  if (!depth) return std::nullopt;
  const auto t = find_column(table, kTemperature), s = find_column(table, kSalinity);
  if (t && s) return Columns{*depth, *t, s, false};
  const auto ct = find_column(table, kConservative), sa = find_column(table, kAbsolute);
  if (ct && sa) return Columns{*depth, *ct, sa, true};
  if (const auto speed = find_column(table, kSpeed)) return Columns{*depth, *speed, std::nullopt, false};
  return std::nullopt;
}

// Accepted range of a column.
struct Limits {
  double lowest, highest;
  const char* unit;
};
constexpr Limits kDepthLimits{0, kDeepestWater, "m"};
constexpr Limits kTemperatureLimits{-5, 45, "degC"};
constexpr Limits kSalinityLimits{0, 50, "psu"};
constexpr Limits kSpeedLimits{1000, 2000, "m/s"};

// Reads a cell as a number. If it is not a number or out of limits, returns NaN and adds a line to `errors`.
double read_cell(const CsvTable& table, const CsvLine& row, std::size_t column, const Limits& limits,
                 std::vector<std::string>& errors) {
  const auto value = parse_number(row.cells[column]);
  if (value && *value >= limits.lowest && *value <= limits.highest) return *value;
  errors.push_back("line " + std::to_string(row.number) + ", " + table.header.cells[column] + ": '" +
                   row.cells[column] + "'; allowed is a number from " + format_number(limits.lowest) +
                   " to " + format_number(limits.highest) + " " + limits.unit);
  return std::nan("");
}

// The depth of a row with its line in the file.
struct DepthAt {
  double depth_m;
  int line;
};

// Reports depths that do not increase: in one sentence when the rows are the legs of a cast, otherwise one
// line each.
void check_rising(const std::vector<DepthAt>& depths, std::vector<std::string>& errors) {
  const auto does_not_rise = [](const DepthAt& a, const DepthAt& b) { return b.depth_m <= a.depth_m; };
  const auto does_not_fall = [](const DepthAt& a, const DepthAt& b) { return b.depth_m >= a.depth_m; };
  const auto turn = std::adjacent_find(depths.begin(), depths.end(), does_not_rise);
  if (turn == depths.end()) return;
  const auto lines = [](auto first, auto last) {
    return "lines " + std::to_string(first->line) + " to " + std::to_string((last - 1)->line);
  };
  constexpr std::ptrdiff_t kLeg = 3;  // rows; fewer are reported as single faults
  const bool comes_up = std::adjacent_find(turn + 1, depths.end(), does_not_fall) == depths.end();
  if (comes_up && depths.end() - turn > kLeg) {
    errors.push_back(turn == depths.begin()
                         ? "depths fall: " + lines(depths.begin(), depths.end()) +
                               " are of the way up; reverse their order, so that depths rise"
                         : "the cast goes down and up, and turns at " + format_number(turn->depth_m) +
                               " m: keep the way down, " + lines(depths.begin(), turn + 1) +
                               ", or the way up, " + lines(turn + 1, depths.end()) + " in reverse order");
    return;
  }
  for (std::size_t i = 1; i < depths.size(); ++i) {
    if (does_not_rise(depths[i - 1], depths[i]))
      errors.push_back("line " + std::to_string(depths[i].line) +
                       ", depth_m: " + format_number(depths[i].depth_m) + " m is not below the row before (" +
                       format_number(depths[i - 1].depth_m) + " m); depths must rise");
  }
}

// Throws InvalidArgument with the first five errors and the number of the others.
void throw_all(const std::string& name, const std::vector<std::string>& errors) {
  if (errors.empty()) return;
  constexpr std::size_t kShown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, errors.size()); ++i)
    text += (text.empty() ? "" : "\n") + name + ": " + errors[i];
  if (errors.size() > kShown)
    text += "\n" + name + ": and " + std::to_string(errors.size() - kShown) + " more";
  throw InvalidArgument(text);
}

// One line about the nearest column of a gridded field.
std::string describe(const ocean::WaterColumn& column) {
  std::ostringstream text;
  text.precision(4);
  text << std::fixed << "nearest column at " << to_degrees(column.nearest_latitude_rad) << " N "
       << to_degrees(column.nearest_longitude_rad) << " E, ";
  text.precision(1);
  text << column.distance_m / 1000 << " km away, " << column.rows.size() << " levels";
  return text.str();
}

}  // namespace

SoundSpeedProfile read_csv_profile(std::istream& in, const std::string& name, const ProfileReading& reading) {
  std::vector<std::string> errors;
  const CsvTable table = read_csv(in, errors);
  const auto columns = find_columns(table);
  if (!columns) errors.push_back(kNeeded);
  throw_all(name, errors);

  std::vector<WaterRow> water;
  std::vector<SpeedRow> speeds;
  std::vector<DepthAt> depths;
  for (const CsvLine& row : table.rows) {
    const double depth = read_cell(table, row, columns->depth, kDepthLimits, errors);
    if (!std::isnan(depth)) depths.push_back({depth, row.number});
    if (columns->second) {
      const double t = read_cell(table, row, columns->first, kTemperatureLimits, errors);
      water.push_back({depth, t, read_cell(table, row, *columns->second, kSalinityLimits, errors)});
    } else {
      speeds.push_back({depth, read_cell(table, row, columns->first, kSpeedLimits, errors)});
    }
  }
  check_rising(depths, errors);
  if (table.rows.empty()) errors.push_back("no row after the header");
  const bool wants_teos10 = reading.model == SoundSpeedModel::kTeos10;
  if (columns->second && wants_teos10 && !columns->teos10) {
    errors.push_back("the model teos10 needs the columns CT_degC and SA_g_per_kg");
  }
  throw_all(name, errors);
  if (!columns->second) return SoundSpeedProfile::from_speeds(std::move(speeds), reading.assumed);
  const SoundSpeedModel model = columns->teos10 ? SoundSpeedModel::kTeos10 : reading.model;
  return SoundSpeedProfile::from_water(std::move(water), model, reading.latitude_rad);
}

GridProfile read_grid_profile(const GridQuery& query, SoundSpeedModel model) {
  require(model != SoundSpeedModel::kTeos10,
          "gridded climatologies hold no absolute salinity: teos10 cannot use them");
  require_in_range(query.latitude_rad, -std::numbers::pi / 2, std::numbers::pi / 2, "latitude", "rad");
  require_finite(query.longitude_rad, "longitude");
  const ocean::WaterColumn column = ocean::read_water_column(query);
  std::vector<WaterRow> rows;
  for (const ocean::WaterAtDepth& at : column.rows)
    rows.push_back({at.depth_m, at.temperature_degc, at.salinity_psu});
  const int levels = static_cast<int>(rows.size());
  return {SoundSpeedProfile::from_water(std::move(rows), model, query.latitude_rad),
          column.nearest_latitude_rad,
          column.nearest_longitude_rad,
          column.distance_m,
          levels,
          describe(column)};
}

bool is_profile_table(const std::string& path) {
  return path.ends_with(".csv") || path.ends_with(".CSV") || path.ends_with(".txt");
}

SoundSpeedProfile read_profile(const std::string& path, const ProfileReading& reading, double latitude_rad,
                               double longitude_rad) {
  if (!is_profile_table(path)) {
    return read_grid_profile({path, "", latitude_rad, longitude_rad, 0}, reading.model).profile;
  }
  std::ifstream file = open_input(path);
  return read_csv_profile(file, path, reading);
}

}  // namespace halocline::acoustics
