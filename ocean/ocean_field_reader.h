// SPDX-License-Identifier: BSD-3-Clause
// Reader of ocean fields and water columns from CF netCDF files as HYCOM, ROMS on depth levels, Copernicus
// Marine and the World Ocean Atlas publish them. All water in netCDF files is read here.
//
// Layout: each variable on depth, latitude, longitude and time (or none), in any order (ocean/cf_grid.h).
// Variables are found by standard_name, else by name (ocean/sea_variables.h):
//
//   standard_name                         names
//   eastward_sea_water_velocity           water_u, uo, u_eastward, u
//   northward_sea_water_velocity          water_v, vo, v_northward, v
//   sea_water_temperature                 water_temp, temperature, temp, t_an, TEMP
//   sea_water_potential_temperature       thetao; converted to in situ (ocean/potential_temperature.h)
//   sea_water_salinity,
//     sea_water_practical_salinity        salinity, so, salt, s_an, SALT
//   sea_water_absolute_salinity,
//     _reference_, _preformed_            converted to practical salinity, with a remark
//
// Missing values and packing: ocean/netcdf_file.h. Units: ocean/cf_units.h, ocean/cf_time.h. The header of a
// file is checked before the file is opened (ocean/netcdf_header.h): truncated and damaged files are refused.
//
// netCDF is linked into a separate module (halocline_ocean_fields.so), which the first file loads. Calls may
// overlap between threads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ocean/ocean_field.h"

namespace halocline::ocean {

struct FieldQuery {
  std::string path;
  std::string start_date;  // date of simulation time 0; empty: the file's first time
  GeodeticOrigin origin;
};

// Returns the field of a file. Equal queries share one field as long as any of them keeps it. Throws
// InvalidArgument that names the file, the variable and what is allowed: for a file that cannot be read, has
// none of the variables or another layout; for what OceanField refuses; for a start outside of the file's
// times; for more than 1e8 values of a variable.
std::shared_ptr<const OceanField> read_ocean_field(const FieldQuery& query);

// Position in a grid of water, and the files to read.
struct ColumnQuery {
  std::string temperature_path;
  std::string salinity_path = {};  // empty: the same file
  double latitude_rad = 0;         // -pi/2..pi/2
  double longitude_rad = 0;        // any number of turns
  int time_index = 0;              // for a file with several times, from 0
};

inline constexpr double kFarthestColumn = 300'000;  // m; water further away does not represent a position

struct WaterColumn {
  std::vector<WaterAtDepth> rows;                      // sorted by depth, down to the deepest value
  double nearest_latitude_rad, nearest_longitude_rad;  // nearest column with water; longitude -pi..pi
  double distance_m;                                   // distance of that column, on a sphere
};

// Returns the water at a position, equal to OceanField::column_at of the same file; beyond the grid and among
// land, that of the nearest column with water. Reads only what lies within kFarthestColumn. Throws as
// read_ocean_field does, and when no water lies within that distance or the file has no such time.
WaterColumn read_water_column(const ColumnQuery& query);

// Types of the functions halocline_read_ocean_field and halocline_read_water_column that the module exports;
// the caller owns the result.
using OceanFieldReader = OceanField*(const FieldQuery& query);
using WaterColumnReader = WaterColumn*(const ColumnQuery& query);

}  // namespace halocline::ocean
