// SPDX-License-Identifier: BSD-3-Clause
// Selection of the variables of a netCDF file that hold the quantities of the sea, and conversion of their
// values.
//
// A standard name takes precedence over a name: names count only where the standard name is absent or one of
// the same quantity. Among several variables with one standard name, the one with the most dimensions is
// used. "Potential temperature" and "absolute salinity" in a long name count like the standard names.
// Absolute, reference and preformed salinity S_A is converted to practical salinity (IOC, SCOR and IAPSO
// 2010, TEOS-10, without anomaly) by
//
//   S_P = S_A * 35 / 35.16504
//
// Error: 0.03 in the open ocean, 0.09 in the Baltic. Conservative temperature is refused. Part of the module
// halocline_ocean_fields.so.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ocean/cf_grid.h"
#include "ocean/netcdf_file.h"
#include "ocean/ocean_field.h"

namespace halocline::ocean {

struct TemperatureVariable {
  std::string variable;
  bool is_potential = false;
};
struct SalinityVariable {
  std::string variable;
  bool is_absolute = false;
};

// Returns the variable; empty when the file has none of the quantity. Throws InvalidArgument for conservative
// temperature.
std::optional<std::string> find_eastward(const NetcdfFile& file);
std::optional<std::string> find_northward(const NetcdfFile& file);
std::optional<TemperatureVariable> find_temperature(const NetcdfFile& file);
std::optional<SalinityVariable> find_salinity(const NetcdfFile& file);

// Returns values in m/s, practical salinity, and degrees Celsius in situ or potential. Throws InvalidArgument
// for units of another quantity, and for salinities that look like kg/kg.
std::vector<float> read_speed(const CfGrid& grid, const NetcdfFile& file, const std::string& variable);
std::vector<float> read_salinity(const CfGrid& grid, const NetcdfFile& file,
                                 const SalinityVariable& salinity);
std::vector<float> read_temperature(const CfGrid& grid, const NetcdfFile& file,
                                    const TemperatureVariable& temperature);

// Converts potential temperatures to those in situ, with the salinities of `values`.
void make_in_situ(const OceanGrid& grid, OceanValues& values);

// Returns the remark on a conversion of salinity, for OceanField::remarks; empty without one.
std::vector<std::string> remarks_on(const SalinityVariable& salinity);

}  // namespace halocline::ocean
