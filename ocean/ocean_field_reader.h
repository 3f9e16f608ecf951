// SPDX-License-Identifier: BSD-3-Clause
// Reads an ocean field from a CF netCDF file, as HYCOM, ROMS on levels of depth and Copernicus Marine publish them.
//
// Layout: each variable on [time,] depth, latitude, longitude, in this order, each with a coordinate variable of one dimension
// that rises or falls. Variables are found by standard_name, else by name:
//   eastward_sea_water_velocity    water_u, uo, u_eastward, u
//   northward_sea_water_velocity   water_v, vo, v_northward, v
//   sea_water_temperature          water_temp, temperature, temp
//   sea_water_potential_temperature thetao: turned into in-situ temperature (Bryden 1973, through Fofonoff and Millard 1983)
//   sea_water_salinity, sea_water_practical_salinity    salinity, so, salt
// scale_factor, add_offset, _FillValue, missing_value, valid_min, valid_max and valid_range are obeyed; NaN is missing. Units: m/s
// and cm/s; degrees Celsius and kelvin; psu, 1 and 1e-3; m; degrees north and east; ocean/cf_time.h. positive = "up" turns
// depths round. Grids whose axes have two dimensions (curvilinear, s-levels) have to be interpolated to a regular one before.
//
// netCDF is in a module of its own (halocline_ocean_fields.so), loaded by the first file. Calls may overlap between threads.
#pragma once

#include <memory>
#include <string>

#include "ocean/ocean_field.h"

namespace halocline::ocean {

struct FieldQuery {
  std::string path;
  std::string start_date;  // of simulation time 0; empty: the file's first time
  GeodeticOrigin origin;
};

// The field of several queries alike is read once, as long as one of them is kept. Throws InvalidArgument that names the file,
// the variable and what is allowed: a file that cannot be read, without any of the variables, or of another layout; what
// OceanField refuses; a start outside of its times; more than 1e8 values of a variable.
std::shared_ptr<const OceanField> read_ocean_field(const FieldQuery& query);

// What the module exports as halocline_read_ocean_field; the caller owns the result.
using OceanFieldReader = OceanField*(const FieldQuery& query);

}  // namespace halocline::ocean
