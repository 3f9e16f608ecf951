// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/csv_table.h"
#include "core/text/lower_case.h"
#include "core/units.h"
#include "ocean/potential_temperature.h"

namespace halocline::ocean {
namespace {

constexpr std::size_t kMaxPlaces = 1'000'000;  // limit for an axis
constexpr double kTurnDeg = 360, kPole = 90, kBeyondPole = 90.5;

bool is_height(std::string_view name) { return name.starts_with("height") || name.starts_with("altitude"); }

AxisKind kind_by_standard_name(const std::string& name) {
  if (name == "time") return AxisKind::kTime;
  if (name == "latitude") return AxisKind::kLatitude;
  if (name == "longitude") return AxisKind::kLongitude;
  const bool is_vertical =
      name.starts_with("depth") || is_height(name) || name.find("pressure") != std::string::npos;
  return is_vertical ? AxisKind::kDepth : AxisKind::kOther;
}

AxisKind kind_by_units(const std::string& units) {
  if (units.find(" since ") != std::string::npos) return AxisKind::kTime;
  if (direction_in(units) == Direction::kNorth) return AxisKind::kLatitude;
  if (direction_in(units) == Direction::kEast) return AxisKind::kLongitude;
  return unit_in(QuantityKind::kPressure, units) ? AxisKind::kDepth : AxisKind::kOther;
}

template <std::size_t N>
bool is_one_of(const std::string& name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the kind by the variable's name, unless its units contradict it.
AxisKind kind_by_name(const std::string& name, const std::string& units) {
  constexpr std::array<std::string_view, 4> kTimes{"time", "ocean_time", "time_counter", "t"};
  constexpr std::array<std::string_view, 5> kDepths{"depth", "lev", "level", "z", "deptht"};
  constexpr std::array<std::string_view, 3> kLatitudes{"lat", "latitude", "y"};
  constexpr std::array<std::string_view, 3> kLongitudes{"lon", "longitude", "x"};
  const bool is_angle = unit_in(QuantityKind::kAngle, units).has_value();
  if (is_one_of(name, kTimes)) return AxisKind::kTime;
  if (is_one_of(name, kDepths) && unit_in(QuantityKind::kLength, units)) return AxisKind::kDepth;
  if (is_one_of(name, kLatitudes) && is_angle) return AxisKind::kLatitude;
  if (is_one_of(name, kLongitudes) && is_angle) return AxisKind::kLongitude;
  return AxisKind::kOther;
}

[[noreturn]] void refuse_terrain_following(const NetcdfFile& file, const std::string& axis) {
  file.refuse(axis, "its levels follow the terrain (" + file.text(axis, "standard_name") +
                        "), which is not read; allowed are levels of depth or pressure: interpolate to "
                        "such first, by the depths of its formula_terms (cdo intlevel3d, xroms)");
}

// Converts vertical levels to metres, positive down. If no attribute states the direction, levels that are
// all 0 or below are heights.
void make_depths(const NetcdfFile& file, double latitude_deg, CfAxis& axis) {
  const std::string units = file.text(axis.name, "units"),
                    positive = lower_case(file.text(axis.name, "positive")),
                    name = file.text(axis.name, "standard_name");
  if (const auto pressure = unit_in(QuantityKind::kPressure, units)) {
    for (double& value : axis.values) value = unesco_depth_m((*pressure)(value), to_radians(latitude_deg));
    return;
  }
  const UnitFactor metres = unit_of(file, axis.name, QuantityKind::kLength);
  const bool contradicts =
      (positive == "down" && is_height(name)) || (positive == "up" && name.starts_with("depth"));
  if (contradicts)
    file.refuse(axis.name, "positive is \"" + positive + "\" with the standard name " + name +
                               ": they contradict each other");
  const bool is_below =
      std::all_of(axis.values.begin(), axis.values.end(), [](double value) { return value <= 0; });
  const bool is_up = positive == "up" || is_height(name) || (positive.empty() && is_below);
  for (double& value : axis.values) value = metres(value) * (is_up && value != 0 ? -1 : 1);
}

void make_degrees(const NetcdfFile& file, CfAxis& axis) {
  const bool has_units = !file.text(axis.name, "units").empty();
  const UnitFactor degrees = has_units ? unit_of(file, axis.name, QuantityKind::kAngle) : UnitFactor{};
  for (double& value : axis.values) value = degrees(value);
}

// Clamps latitudes to the poles: some grids place their outermost rows half a cell beyond the pole.
void cut_at_poles(CfAxis& latitudes) {
  for (double& value : latitudes.values) {
    if (std::abs(value) <= kBeyondPole) value = std::clamp(value, -kPole, kPole);
  }
}

// Removes one jump of a full turn, as from 179 to -180.
void unwrap(CfAxis& longitudes) {
  std::vector<double>& values = longitudes.values;
  const auto jump = std::adjacent_find(values.begin(), values.end(),
                                       [](double a, double b) { return std::abs(b - a) > kTurnDeg / 2; });
  if (jump == values.end()) return;
  const double turn = *(jump + 1) < *jump ? kTurnDeg : -kTurnDeg;
  std::for_each(jump + 1, values.end(), [turn](double& value) { value += turn; });
}

void make_rising(const NetcdfFile& file, CfAxis& axis) {
  std::vector<double>& values = axis.values;
  if (values.empty()) file.refuse(axis.name, "has no values");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) file.refuse(axis.name, "has a value missing at " + std::to_string(i));
  }
  if (values.size() > 1 && values.front() > values.back()) {
    std::reverse(values.begin(), values.end());
    std::reverse(axis.places.begin(), axis.places.end());
  }
  const auto wrong =
      std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return !(b > a); });
  if (wrong == values.end()) return;
  const std::size_t place = axis.places[static_cast<std::size_t>(wrong - values.begin()) + 1];
  file.refuse(axis.name, "neither rises nor falls throughout, at " + std::to_string(place));
}

std::string range_in_words(const NetcdfFile& file, const std::string& variable) {
  std::size_t places = 1;
  for (const std::string& dimension : file.dimensions_of(variable))
    places *= std::min(file.length_of(dimension), kMaxPlaces + 1);
  if (places > kMaxPlaces) return "many";
  std::vector<double> values = file.values(variable);
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return "nothing";
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return format_number(*least) + " to " + format_number(*greatest);
}

}  // namespace

UnitFactor unit_of(const NetcdfFile& file, const std::string& variable, QuantityKind quantity) {
  const std::string units = file.text(variable, "units");
  if (const auto unit = unit_in(quantity, units)) return *unit;
  file.refuse(variable, "units are \"" + units + "\"; allowed are " + allowed_units(quantity));
}

std::vector<std::string> auxiliary_coordinates(const NetcdfFile& file, const std::string& variable) {
  std::istringstream words(file.text(variable, "coordinates"));
  std::vector<std::string> names;
  for (std::string name; words >> name;) {
    if (file.has(name)) names.push_back(name);
  }
  return names;
}

std::string coordinate_of(const NetcdfFile& file, const std::string& variable, const std::string& dimension) {
  const auto is_alone = [&](const std::string& name) {
    return file.dimensions_of(name) == std::vector{dimension};
  };
  if (file.has(dimension) && is_alone(dimension)) return dimension;
  for (const std::string& name : auxiliary_coordinates(file, variable)) {
    if (is_alone(name) && kind_of(file, name) != AxisKind::kOther) return name;
  }
  return {};
}

AxisKind kind_of(const NetcdfFile& file, const std::string& axis) {
  const std::string name = file.text(axis, "standard_name"), units = lower_case(file.text(axis, "units")),
                    letter = file.text(axis, "axis");
  const bool follows_terrain = (name.starts_with("ocean_") && name.find("coordinate") != std::string::npos) ||
                               !file.text(axis, "formula_terms").empty();
  if (follows_terrain) refuse_terrain_following(file, axis);
  if (!name.empty() && kind_by_standard_name(name) != AxisKind::kOther) return kind_by_standard_name(name);
  if (name.starts_with("projection_") || name.starts_with("grid_")) return AxisKind::kOther;
  if (const AxisKind kind = kind_by_units(units); kind != AxisKind::kOther) return kind;
  if (letter == "T") return AxisKind::kTime;
  if (letter == "Z" || !file.text(axis, "positive").empty()) return AxisKind::kDepth;
  return kind_by_name(lower_case(axis), units);
}

CfAxis read_axis(const NetcdfFile& file, const std::string& name, AxisKind kind, double latitude_deg) {
  const std::vector<std::string> dimensions = file.dimensions_of(name);
  CfAxis axis{.name = name, .dimension = dimensions.empty() ? "" : dimensions.front()};
  const std::size_t length = dimensions.empty() ? 1 : file.length_of(axis.dimension);
  if (length > kMaxPlaces)
    file.refuse(name, "has " + std::to_string(length) + " values; allowed are 1000000");
  if (length == 0) file.refuse(name, "has no values");
  axis.values = file.values(name);
  axis.places.resize(length);
  std::iota(axis.places.begin(), axis.places.end(), std::size_t{0});
  if (kind == AxisKind::kDepth) make_depths(file, latitude_deg, axis);
  if (kind == AxisKind::kLatitude || kind == AxisKind::kLongitude) make_degrees(file, axis);
  if (kind == AxisKind::kLongitude) unwrap(axis);
  if (kind == AxisKind::kLatitude) cut_at_poles(axis);
  make_rising(file, axis);
  return axis;
}

void move_seam(CfAxis& longitudes, double longitude_deg) {
  std::vector<double>& values = longitudes.values;
  if (values.size() < 2) return;
  constexpr double kClosed = 1e-3;  // share of a step, for the rounding of axes
  const double count = static_cast<double>(values.size()),
               step = (values.back() - values.front()) / (count - 1);
  if (std::abs(values.back() - values.front() - kTurnDeg) <= kClosed * step) {
    values.pop_back();
    longitudes.places.pop_back();
  } else if (std::abs(count * step - kTurnDeg) > step / 2) {
    return;
  }
  std::vector<std::pair<double, std::size_t>> moved;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double turns = std::floor((values[i] - (longitude_deg - kTurnDeg / 2)) / kTurnDeg);
    moved.emplace_back(values[i] - kTurnDeg * turns, longitudes.places[i]);
  }
  std::sort(moved.begin(), moved.end());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    values[i] = moved[i].first;
    longitudes.places[i] = moved[i].second;
  }
}

std::string curvilinear_places(const NetcdfFile& file, const std::string& variable) {
  std::string latitudes, longitudes;
  std::vector<std::string> names = auxiliary_coordinates(file, variable);
  if (names.empty()) names = file.variables();
  for (const std::string& name : names) {
    if (file.dimensions_of(name).size() != 2) continue;
    const std::string standard = file.text(name, "standard_name"),
                      units = lower_case(file.text(name, "units"));
    const AxisKind kind = standard.empty() ? kind_by_units(units) : kind_by_standard_name(standard);
    if (kind == AxisKind::kLatitude) latitudes = name;
    if (kind == AxisKind::kLongitude) longitudes = name;
  }
  if (latitudes.empty() || longitudes.empty()) return {};
  return "its places are in two dimensions (" + latitudes + ", " + longitudes +
         "): " + range_in_words(file, latitudes) + " N, " + range_in_words(file, longitudes) + " E";
}

}  // namespace halocline::ocean
