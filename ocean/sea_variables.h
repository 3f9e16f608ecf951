// SPDX-License-Identifier: BSD-3-Clause
// Which variable of a netCDF file holds which quantity of the sea, and what turns its values into ours.
//
// A standard name goes before a name: names count only where the standard name is absent or one of the same
// quantity. Of several with one standard name, the one with the most dimensions. "Potential temperature" and
// "absolute salinity" in a long name count like the standard names. Absolute, reference and preformed
// salinity S_A become practical by S_P = S_A * 35 / 35.16504 (IOC, SCOR and IAPSO 2010, TEOS-10, with no
// anomaly): 0.03 off in the open ocean, 0.09 in the Baltic. Conservative temperature is refused. Part of the
// module halocline_ocean_fields.so.
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

// None where the file has no variable of the quantity. Throws InvalidArgument for conservative temperature.
std::optional<std::string> find_eastward(const NetcdfFile& file);
std::optional<std::string> find_northward(const NetcdfFile& file);
std::optional<TemperatureVariable> find_temperature(const NetcdfFile& file);
std::optional<SalinityVariable> find_salinity(const NetcdfFile& file);

// In m/s, practical salinity, degrees Celsius in situ or potential. Throws InvalidArgument for units of
// something else, and for salinities that look like kg/kg.
std::vector<float> read_speed(const CfGrid& grid, const NetcdfFile& file, const std::string& variable);
std::vector<float> read_salinity(const CfGrid& grid, const NetcdfFile& file,
                                 const SalinityVariable& salinity);
std::vector<float> read_temperature(const CfGrid& grid, const NetcdfFile& file,
                                    const TemperatureVariable& temperature);

// Potential temperatures, with the salinities beside them, become those in situ.
void make_in_situ(const OceanGrid& grid, OceanValues& values);

// For refusals: what is converted is said once, as a remark of the field.
std::vector<std::string> remarks_on(const SalinityVariable& salinity);

}  // namespace halocline::ocean
