// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/profile_reader.h"

#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/csv_table.h"
#include "core/shared_module.h"

namespace halocline::acoustics {
namespace {

// Names a column may have, ours first, then those of the reference tables.
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

std::optional<std::size_t> find_column(const CsvTable& table, const Names& names) {
  for (const std::string& name : names) {
    if (const auto column = table.column(name)) return column;
  }
  return std::nullopt;
}

struct Columns {
  std::size_t depth;
  std::size_t first;                  // temperature or speed
  std::optional<std::size_t> second;  // salinity; none with speed
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

struct Limits {
  double lowest, highest;
  const char* unit;
};
constexpr Limits kDepthLimits{0, kDeepestWater, "m"};
constexpr Limits kTemperatureLimits{-5, 45, "degC"};
constexpr Limits kSalinityLimits{0, 50, "psu"};
constexpr Limits kSpeedLimits{1000, 2000, "m/s"};

// The cell as a number; NaN, and a line in `errors`, when it is none or out of its limits.
double read_cell(const CsvTable& table, const CsvLine& row, std::size_t column, const Limits& limits,
                 std::vector<std::string>& errors) {
  const auto value = parse_number(row.cells[column]);
  if (value && *value >= limits.lowest && *value <= limits.highest) return *value;
  errors.push_back("line " + std::to_string(row.number) + ", " + table.header.cells[column] + ": '" +
                   row.cells[column] + "'; allowed is a number from " + format_number(limits.lowest) +
                   " to " + format_number(limits.highest) + " " + limits.unit);
  return std::nan("");
}

void check_rising(double depth_m, double before_m, int line, std::vector<std::string>& errors) {
  if (depth_m > before_m || std::isnan(depth_m) || std::isnan(before_m)) return;
  errors.push_back("line " + std::to_string(line) + ", depth_m: " + format_number(depth_m) +
                   " m is not below the row before (" + format_number(before_m) + " m); depths must rise");
}

void throw_all(const std::string& name, const std::vector<std::string>& errors) {
  if (errors.empty()) return;
  std::string text;
  for (const std::string& error : errors) text += (text.empty() ? "" : "\n") + name + ": " + error;
  throw InvalidArgument(text);
}

bool ends_with_any(const std::string& path, std::initializer_list<const char*> endings) {
  for (const char* ending : endings) {
    if (path.ends_with(ending)) return true;
  }
  return false;
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
  double before = -1;
  for (const CsvLine& row : table.rows) {
    const double depth = read_cell(table, row, columns->depth, kDepthLimits, errors);
    check_rising(depth, before, row.number, errors);
    before = depth;
    if (columns->second) {
      const double t = read_cell(table, row, columns->first, kTemperatureLimits, errors);
      water.push_back({depth, t, read_cell(table, row, *columns->second, kSalinityLimits, errors)});
    } else {
      speeds.push_back({depth, read_cell(table, row, columns->first, kSpeedLimits, errors)});
    }
  }
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
  static const auto read = reinterpret_cast<GridProfileReader*>(
      module_symbol("halocline_profile_grids.so", "halocline_read_grid_profile"));
  return std::move(*std::unique_ptr<GridProfile>(read(query, model)));
}

SoundSpeedProfile read_profile(const std::string& path, const ProfileReading& reading, double latitude_rad,
                               double longitude_rad) {
  if (!ends_with_any(path, {".csv", ".CSV", ".txt"})) {
    return read_grid_profile({path, "", latitude_rad, longitude_rad, 0}, reading.model).profile;
  }
  std::ifstream file(path);
  require(file.good(), path + ": cannot be read");
  return read_csv_profile(file, path, reading);
}

}  // namespace halocline::acoustics
