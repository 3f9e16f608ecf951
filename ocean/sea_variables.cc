// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/sea_variables.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/text/lower_case.h"
#include "ocean/cf_units.h"
#include "ocean/potential_temperature.h"

namespace halocline::ocean {
namespace {

using Names = std::vector<std::string_view>;

constexpr double kPracticalOfAbsolute = 35 / 35.16504;  // TEOS-10, reference composition

// Returns the standard name; empty when a modifier gives it another meaning ("sea_water_temperature
// status_flag").
std::string standard_name(const NetcdfFile& file, const std::string& variable) {
  const std::string whole = file.text(variable, "standard_name");
  return whole.find(' ') == std::string::npos ? whole : "";
}

bool long_name_has(const NetcdfFile& file, const std::string& variable, std::string_view words) {
  return lower_case(file.text(variable, "long_name")).find(words) != std::string::npos;
}

bool is_among(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::optional<std::string> by_standard_name(const NetcdfFile& file, const Names& names) {
  for (const std::string_view name : names) {
    std::optional<std::string> best;
    std::size_t most = 0;
    for (const std::string& variable : file.variables()) {
      const std::size_t dimensions = file.dimensions_of(variable).size();
      if (standard_name(file, variable) != name || (best && dimensions <= most)) continue;
      best = variable;
      most = dimensions;
    }
    if (best) return best;
  }
  return std::nullopt;
}

std::optional<std::string> by_name(const NetcdfFile& file, const Names& standard_names, const Names& names) {
  for (const std::string_view name : names) {
    const std::string variable(name);
    if (!file.has(variable)) continue;
    const std::string standard = file.text(variable, "standard_name");
    if (standard.empty() || is_among(standard_names, standard)) return variable;
  }
  return std::nullopt;
}

std::optional<std::string> find(const NetcdfFile& file, const Names& standard_names, const Names& names) {
  const auto variable = by_standard_name(file, standard_names);
  return variable ? variable : by_name(file, standard_names, names);
}

void refuse_conservative(const NetcdfFile& file) {
  auto variable = by_standard_name(file, {"sea_water_conservative_temperature"});
  if (!variable && file.has("CT")) variable = "CT";
  if (variable)
    file.refuse(*variable,
                "is conservative temperature, which is not read; allowed are temperature in situ and "
                "potential temperature: convert it (gsw.pt_from_CT)");
}

const Names kAbsolute{"sea_water_absolute_salinity", "sea_water_reference_salinity",
                      "sea_water_preformed_salinity"};

}  // namespace

std::optional<std::string> find_eastward(const NetcdfFile& file) {
  return find(file, {"eastward_sea_water_velocity", "sea_water_x_velocity"},
              {"water_u", "uo", "u_eastward", "u"});
}

std::optional<std::string> find_northward(const NetcdfFile& file) {
  return find(file, {"northward_sea_water_velocity", "sea_water_y_velocity"},
              {"water_v", "vo", "v_northward", "v"});
}

std::optional<TemperatureVariable> find_temperature(const NetcdfFile& file) {
  if (const auto potential = by_standard_name(file, {"sea_water_potential_temperature"}))
    return TemperatureVariable{*potential, true};
  if (const auto found = find(file, {"sea_water_temperature"},
                              {"water_temp", "temperature", "temp", "t_an", "T_AN", "TEMP"}))
    return TemperatureVariable{*found, long_name_has(file, *found, "potential temperature")};
  if (const auto potential = by_name(file, {}, {"thetao"})) return TemperatureVariable{*potential, true};
  refuse_conservative(file);
  return std::nullopt;
}

std::optional<SalinityVariable> find_salinity(const NetcdfFile& file) {
  const auto practical = find(file, {"sea_water_practical_salinity", "sea_water_salinity"},
                              {"salinity", "so", "salt", "s_an", "S_AN", "SALT"});
  if (practical) return SalinityVariable{*practical, long_name_has(file, *practical, "absolute salinity")};
  const auto absolute = by_standard_name(file, kAbsolute);
  return absolute ? std::optional(SalinityVariable{*absolute, true}) : std::nullopt;
}

std::vector<float> read_speed(const CfGrid& grid, const NetcdfFile& file, const std::string& variable) {
  return grid.read(variable, unit_of(file, variable, QuantityKind::kSpeed));
}

std::vector<float> read_salinity(const CfGrid& grid, const NetcdfFile& file,
                                 const SalinityVariable& salinity) {
  UnitFactor unit = unit_of(file, salinity.variable, QuantityKind::kSalinity);
  if (salinity.is_absolute) unit.factor *= kPracticalOfAbsolute;
  std::vector<float> values = grid.read(salinity.variable, unit);
  constexpr float kMinPlausible = 0.1F;  // psu; the ocean has 0.03 to 0.04 kg/kg
  float most = 0;
  for (const float value : values) most = std::isnan(value) ? most : std::max(most, value);
  if (most > 0 && most < kMinPlausible)
    file.refuse(salinity.variable, "no value is above " + std::to_string(most) +
                                       ", as if it were kg/kg; allowed is practical salinity, or g/kg");
  return values;
}

std::vector<float> read_temperature(const CfGrid& grid, const NetcdfFile& file,
                                    const TemperatureVariable& temperature) {
  return grid.read(temperature.variable, unit_of(file, temperature.variable, QuantityKind::kTemperature));
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

std::vector<std::string> remarks_on(const SalinityVariable& salinity) {
  if (!salinity.is_absolute) return {};
  return {salinity.variable +
          " is absolute salinity: made practical by 35 / 35.16504, 0.03 psu off at most in the open ocean"};
}

}  // namespace halocline::ocean
