// SPDX-License-Identifier: BSD-3-Clause
// Ocean fields from CF netCDF files. Part of the module halocline_ocean_fields.so, which only ocean_field_reader.cc loads.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/check.h"
#include "core/units.h"
#include "ocean/cf_time.h"
#include "ocean/netcdf_file.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "ocean/potential_temperature.h"

namespace halocline::ocean {
namespace {

constexpr double kMostValues = 1e8;             // of a variable, 0.4 GB
constexpr double kMostValuesOfAByte = 300;      // deflate packs 1032 bytes into one; more were never written
constexpr std::size_t kMostPlaces = 1'000'000;  // of an axis
constexpr double kKelvin = 273.15;              // of 0 degC

using Names = std::vector<std::string_view>;

std::optional<std::string> by_standard_name(const NetcdfFile& file, const Names& names) {
  for (const std::string_view name : names) {
    for (const std::string& variable : file.variables()) {
      if (file.text(variable, "standard_name") == name) return variable;
    }
  }
  return std::nullopt;
}

std::optional<std::string> by_name(const NetcdfFile& file, const Names& names) {
  const std::vector<std::string> variables = file.variables();
  for (const std::string_view name : names) {
    if (std::find(variables.begin(), variables.end(), name) != variables.end()) return std::string(name);
  }
  return std::nullopt;
}

std::optional<std::string> find_variable(const NetcdfFile& file, const Names& standard_names,
                                         const Names& names) {
  const auto variable = by_standard_name(file, standard_names);
  return variable ? variable : by_name(file, names);
}

struct UnitFactor {
  std::string_view unit;
  double factor, offset = 0;
};
constexpr std::array kSpeedUnits{UnitFactor{"m/s", 1},          UnitFactor{"m s-1", 1},
                                 UnitFactor{"m s^-1", 1},       UnitFactor{"meter second-1", 1},
                                 UnitFactor{"meter/second", 1}, UnitFactor{"cm/s", 0.01},
                                 UnitFactor{"cm s-1", 0.01}};
constexpr std::array kTemperatureUnits{
    UnitFactor{"degC", 1},     UnitFactor{"degrees_C", 1},      UnitFactor{"Celsius", 1},
    UnitFactor{"celsius", 1},  UnitFactor{"degree_Celsius", 1}, UnitFactor{"degrees_Celsius", 1},
    UnitFactor{"degree_C", 1}, UnitFactor{"K", 1, -kKelvin},    UnitFactor{"kelvin", 1, -kKelvin}};
constexpr std::array kSalinityUnits{UnitFactor{"psu", 1},   UnitFactor{"PSU", 1},    UnitFactor{"1e-3", 1},
                                    UnitFactor{"0.001", 1}, UnitFactor{"g kg-1", 1}, UnitFactor{"1", 1}};
constexpr std::array kDepthUnits{UnitFactor{"m", 1}, UnitFactor{"meter", 1}, UnitFactor{"meters", 1},
                                 UnitFactor{"metre", 1}, UnitFactor{"metres", 1}};

template <std::size_t N>
UnitFactor unit_of(const NetcdfFile& file, const std::string& variable,
                   const std::array<UnitFactor, N>& known) {
  const std::string unit = file.text(variable, "units");
  std::string allowed;
  for (const UnitFactor& one : known) {
    if (one.unit == unit) return one;
    allowed += (allowed.empty() ? "" : ", ") + std::string(one.unit);
  }
  file.refuse(variable, "units are \"" + unit + "\"; allowed are " + allowed);
}

enum class AxisKind { kTime, kDepth, kLatitude, kLongitude, kUnknown };
constexpr std::array<std::string_view, 5> kAxisNames{"time", "depth", "latitude", "longitude", "unknown"};

AxisKind kind_of(const NetcdfFile& file, const std::string& axis) {
  const std::string units = file.text(axis, "units"), standard = file.text(axis, "standard_name"),
                    letter = file.text(axis, "axis");
  if (standard == "time" || letter == "T" || units.find(" since ") != std::string::npos)
    return AxisKind::kTime;
  if (standard == "latitude" || units.starts_with("degrees_n") || units.starts_with("degree_n"))
    return AxisKind::kLatitude;
  if (standard == "longitude" || units.starts_with("degrees_e") || units.starts_with("degree_e"))
    return AxisKind::kLongitude;
  if (standard == "depth" || letter == "Z" || !file.text(axis, "positive").empty()) return AxisKind::kDepth;
  return AxisKind::kUnknown;
}

// One axis as the file has it: its values in the order of the file, and whether they fall.
struct Axis {
  std::string name;
  std::vector<double> values;
  bool falls = false;
};

// The axes of the file's variables, which all are on the same ones.
class Axes {
 public:
  Axes(const NetcdfFile& file, const std::string& variable) : file_(file) {
    std::vector<AxisKind> kinds;
    for (const std::string& dimension : file.dimensions_of(variable)) {
      const std::vector<std::string> variables = file.variables();
      if (std::find(variables.begin(), variables.end(), dimension) == variables.end() ||
          file.dimensions_of(dimension) != std::vector{dimension}) {
        file.refuse(variable, "its dimension " + dimension +
                                  " has no coordinate variable of one dimension; allowed are regular grids");
      }
      kinds.push_back(kind_of(file, dimension));
      dimensions_.push_back(dimension);
      axes_[static_cast<std::size_t>(kinds.back())] = read(dimension);
    }
    using enum AxisKind;
    const bool has_time = !kinds.empty() && kinds.front() == kTime;
    if (has_time) kinds.erase(kinds.begin());
    if (kinds != std::vector{kDepth, kLatitude, kLongitude}) {
      std::string found;
      for (const AxisKind kind : kinds)
        found += (found.empty() ? "" : ", ") + std::string(kAxisNames[static_cast<std::size_t>(kind)]);
      file.refuse(variable, "its axes are " + std::string(has_time ? "time, " : "") + found +
                                "; allowed are time (or none), depth, latitude, longitude, in this order");
    }
    if (!has_time) axes_[0].values = {0};
  }

  const std::vector<std::string>& dimensions() const { return dimensions_; }
  bool has_time() const { return !at(AxisKind::kTime).name.empty(); }
  const Axis& at(AxisKind kind) const { return axes_[static_cast<std::size_t>(kind)]; }
  std::size_t size(AxisKind kind) const { return at(kind).values.size(); }
  double points() const {
    double product = 1;
    for (const AxisKind kind : {AxisKind::kTime, AxisKind::kDepth, AxisKind::kLatitude, AxisKind::kLongitude})
      product *= static_cast<double>(size(kind));
    return product;
  }

 private:
  Axis read(const std::string& name) const {
    const std::size_t length = file_.length_of(name);
    if (length > kMostPlaces)
      file_.refuse(name, "has " + std::to_string(length) + " values; allowed are 1000000");
    Axis axis{name, file_.values(name, 0, length)};
    if (kind_of(file_, name) == AxisKind::kDepth) {
      unit_of(file_, name, kDepthUnits);
      const bool is_up = file_.text(name, "positive") == "up";
      for (double& depth : axis.values) depth = is_up && depth != 0 ? -depth : depth;
    }
    axis.falls = axis.values.size() > 1 && axis.values.front() > axis.values.back();
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
      if (!std::isfinite(axis.values[i])) file_.refuse(name, "has a value missing at " + std::to_string(i));
      if (i > 0 && !(axis.falls ? axis.values[i] < axis.values[i - 1] : axis.values[i] > axis.values[i - 1]))
        file_.refuse(name, "neither rises nor falls throughout, at " + std::to_string(i));
    }
    return axis;
  }

  const NetcdfFile& file_;
  std::vector<std::string> dimensions_;
  std::array<Axis, 5> axes_;
};

std::vector<double> rising(const Axis& axis) {
  std::vector<double> values = axis.values;
  if (axis.falls) std::reverse(values.begin(), values.end());
  return values;
}

// All of a variable, its axes turned so that they rise.
std::vector<float> read_values(const NetcdfFile& file, const std::string& variable, const Axes& axes,
                               const UnitFactor& unit) {
  if (file.dimensions_of(variable) != axes.dimensions())
    file.refuse(variable, "is on other dimensions than the variables before it; allowed is one grid");
  using enum AxisKind;
  const std::size_t times = axes.size(kTime), depths = axes.size(kDepth), rows = axes.size(kLatitude),
                    columns = axes.size(kLongitude);
  std::vector<float> values(times * depths * rows * columns);
  const auto place = [](const Axis& axis, std::size_t i) {
    return axis.falls ? axis.values.size() - 1 - i : i;
  };
  for (std::size_t time = 0; time < times; ++time) {
    const std::vector<double> read = axes.has_time() ? file.values(variable, place(axes.at(kTime), time), 1)
                                                     : file.values(variable, 0, depths);
    for (std::size_t depth = 0; depth < depths; ++depth) {
      for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t from =
            (place(axes.at(kDepth), depth) * rows + place(axes.at(kLatitude), row)) * columns;
        const std::size_t to = ((time * depths + depth) * rows + row) * columns;
        for (std::size_t column = 0; column < columns; ++column) {
          const double value = read[from + place(axes.at(kLongitude), column)];
          values[to + column] = static_cast<float>(value * unit.factor + unit.offset);
        }
      }
    }
  }
  return values;
}

void make_in_situ(const OceanGrid& grid, OceanValues& values) {
  std::size_t i = 0;
  for (std::size_t time = 0; time < grid.times_s.size(); ++time) {
    for (const double depth : grid.depths_m) {
      for (const double latitude : grid.latitudes_rad) {
        for (std::size_t column = 0; column < grid.longitudes_rad.size(); ++column, ++i) {
          values.temperature_degc[i] = static_cast<float>(
              in_situ_temperature_degc(values.salinity_psu[i], values.temperature_degc[i], depth, latitude));
        }
      }
    }
  }
}

// Times from the start on.
void set_times(const NetcdfFile& file, const Axes& axes, const std::string& start_date, OceanGrid& grid) {
  const Axis& axis = axes.at(AxisKind::kTime);
  if (axis.name.empty()) {
    require(start_date.empty(), file.path() + ": has no times; allowed is no start");
    grid.times_s = {0};
    return;
  }
  try {
    const CfTimeAxis time =
        CfTimeAxis::parse(file.text(axis.name, "units"), file.text(axis.name, "calendar"));
    for (const double value : rising(axis)) grid.times_s.push_back(time.seconds_at(value));
    const double first = grid.times_s.front(), last = grid.times_s.back();
    const double start = start_date.empty() ? first : time.seconds_of(start_date);
    require(start >= first && start <= last, "the start is " + start_date + "; allowed is " +
                                                 time.date_of(first) + " to " + time.date_of(last));
    for (double& seconds : grid.times_s) seconds -= start;
  } catch (const InvalidArgument& error) {
    file.refuse(axis.name, error.what());
  }
}

struct Found {
  std::optional<std::string> east, north, temperature, potential, salinity;
};

Found find_all(const NetcdfFile& file) {
  Found found;
  found.east = find_variable(file, {"eastward_sea_water_velocity"}, {"water_u", "uo", "u_eastward", "u"});
  found.north = find_variable(file, {"northward_sea_water_velocity"}, {"water_v", "vo", "v_northward", "v"});
  // What a standard name says goes before what a name suggests.
  found.potential = by_standard_name(file, {"sea_water_potential_temperature"});
  if (!found.potential)
    found.temperature = find_variable(file, {"sea_water_temperature"}, {"water_temp", "temperature", "temp"});
  if (!found.potential && !found.temperature) found.potential = by_name(file, {"thetao"});
  found.salinity =
      find_variable(file, {"sea_water_salinity", "sea_water_practical_salinity"}, {"salinity", "so", "salt"});
  const bool has_temperature = found.temperature || found.potential;
  require(found.east.has_value() == found.north.has_value(),
          file.path() + ": has one component of the current; allowed are both or none");
  require(has_temperature == found.salinity.has_value(),
          file.path() + ": has temperature or salinity alone; allowed are both or none");
  require(
      found.east || has_temperature,
      file.path() + ": has neither currents nor temperature and salinity (known names: docs/scenarios.md)");
  return found;
}

OceanField* read_field(const FieldQuery& query) {
  const NetcdfFile file(query.path);
  const Found found = find_all(file);
  const Axes axes(file, found.east ? *found.east : *found.salinity);
  const auto bytes = std::filesystem::file_size(query.path);
  require(axes.points() <= std::min(kMostValues, kMostValuesOfAByte * static_cast<double>(bytes)),
          query.path + ": has " + fmt::format("{:.0f}", axes.points()) + " values a variable in " +
              std::to_string(bytes) + " bytes; allowed are 100000000, and 300 a byte: cut out a region");
  OceanGrid grid;
  set_times(file, axes, query.start_date, grid);
  grid.depths_m = rising(axes.at(AxisKind::kDepth));
  for (const double degrees : rising(axes.at(AxisKind::kLatitude)))
    grid.latitudes_rad.push_back(to_radians(degrees));
  for (const double degrees : rising(axes.at(AxisKind::kLongitude)))
    grid.longitudes_rad.push_back(to_radians(degrees));
  OceanValues values;
  if (found.east) {
    values.east_mps = read_values(file, *found.east, axes, unit_of(file, *found.east, kSpeedUnits));
    values.north_mps = read_values(file, *found.north, axes, unit_of(file, *found.north, kSpeedUnits));
  }
  if (found.salinity) {
    const std::string temperature = found.temperature ? *found.temperature : *found.potential;
    values.temperature_degc =
        read_values(file, temperature, axes, unit_of(file, temperature, kTemperatureUnits));
    const bool has_unit = !file.text(*found.salinity, "units").empty();
    const UnitFactor none{"", 1};
    values.salinity_psu = read_values(file, *found.salinity, axes,
                                      has_unit ? unit_of(file, *found.salinity, kSalinityUnits) : none);
    if (found.potential) make_in_situ(grid, values);
  }
  try {
    return new OceanField(std::move(grid), std::move(values), query.origin);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(query.path + ": " + error.what());
  }
}

}  // namespace
}  // namespace halocline::ocean

extern "C" halocline::ocean::OceanFieldReader halocline_read_ocean_field;

halocline::ocean::OceanField* halocline_read_ocean_field(const halocline::ocean::FieldQuery& query) {
  return halocline::ocean::read_field(query);
}
