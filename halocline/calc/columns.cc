// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/calc/columns.h"

#include <cmath>
#include <utility>

#include "acoustics/sea/pressure.h"
#include "core/units.h"

namespace halocline::clients {

InputColumn or_else(InputColumn column, double value) {
  column.otherwise = value;
  return column;
}

InputColumn unread(double value) { return {{}, value, value, value}; }

InputColumn frequency_column(const std::string& name) { return {{name}, 1e-6, 1e6, {}}; }
InputColumn temperature_column(const std::string& name) { return {{name}, -10, 60, {}}; }
InputColumn salinity_column() { return {{"S_ppt", "S_psu"}, 0, 60, {}}; }
InputColumn depth_column(const std::string& name) { return {{name}, 0, 12'000, {}}; }
InputColumn range_column() { return {{"range_m"}, 0, 1e8, {}}; }
InputColumn source_level_column() { return {{"Ptx_dB_re_1uPa_at_1m"}, -300, 400, {}}; }
InputColumn spreading_column() { return {{"k_spreading"}, 0, 4, 1.5}; }
InputColumn shipping_column() { return {{"shipping", "shipping_0_1"}, 0, 1, 0.5}; }
InputColumn wind_column() { return {{"wind_m_per_s"}, 0, 100, 0}; }
InputColumn latitude_column() { return {{"lat_deg"}, -90, 90, 45}; }

std::vector<InputColumn> absorbing_water_columns(acoustics::AbsorptionModel model) {
  using acoustics::AbsorptionModel;
  const bool fisher = model == AbsorptionModel::kFisherSimmons1977;
  const bool salts =
      model == AbsorptionModel::kFrancoisGarrison1982 || model == AbsorptionModel::kAinslieMcColm1998;
  return {fisher || salts ? temperature_column("T_degC") : unread(4),
          salts ? or_else(salinity_column(), 35) : unread(35),
          fisher || salts ? or_else(depth_column("depth_m"), 0) : unread(0),
          fisher ? InputColumn{{"P_atm"}, 0, 2000, kDerived} : unread(kDerived),
          salts ? InputColumn{{"pH"}, 5, 10, 8} : unread(8)};
}

acoustics::AbsorbingWater to_absorbing_water(const std::vector<double>& values, std::size_t first) {
  const double depth = values[first + 2], pressure = values[first + 3];
  const double derived = acoustics::pressure_atm_absolute(depth, to_radians(45));
  return {values[first], values[first + 1], depth, std::isnan(pressure) ? derived : pressure,
          values[first + 4]};
}

std::vector<InputColumn> joined(std::vector<InputColumn> front, const std::vector<InputColumn>& back) {
  front.insert(front.end(), back.begin(), back.end());
  return front;
}

QuantityForm plain(std::string model, std::vector<InputColumn> inputs, std::vector<std::string> outputs,
                   const RowFunction& function) {
  return {std::move(model), std::move(inputs), std::move(outputs),
          [function](const CalcOptions&) { return function; }};
}

}  // namespace halocline::clients
