// SPDX-License-Identifier: BSD-3-Clause
// Reads ocean fields and columns of water from CF netCDF files, as HYCOM, ROMS on levels of depth, Copernicus
// Marine and the World Ocean Atlas publish them: the one reader of water in netCDF.
//
// Layout: each variable on depth, latitude, longitude and time (or none), in any order (ocean/cf_grid.h).
// Variables are found by standard_name, else by name (ocean/sea_variables.h):
//   eastward_sea_water_velocity    water_u, uo, u_eastward, u
//   northward_sea_water_velocity   water_v, vo, v_northward, v
//   sea_water_temperature          water_temp, temperature, temp, t_an, TEMP
//   sea_water_potential_temperature thetao: turned into in-situ temperature (ocean/potential_temperature.h)
//   sea_water_salinity, sea_water_practical_salinity    salinity, so, salt, s_an, SALT
//   sea_water_absolute_salinity, ..reference_, ..preformed_    made practical, with a remark
// Missing values and packing: ocean/netcdf_file.h. Units: ocean/cf_units.h, ocean/cf_time.h. A file is looked
// at before it is opened (ocean/netcdf_header.h): cut short or damaged, it is refused.
//
// netCDF is in a module of its own (halocline_ocean_fields.so), loaded by the first file. Calls may overlap
// between threads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ocean/ocean_field.h"

namespace halocline::ocean {

struct FieldQuery {
  std::string path;
  std::string start_date;  // of simulation time 0; empty: the file's first time
  GeodeticOrigin origin;
};

// The field of several queries alike is read once, as long as one of them is kept. Throws InvalidArgument
// that names the file, the variable and what is allowed: a file that cannot be read, without any of the
// variables, or of another layout; what OceanField refuses; a start outside of its times; more than 1e8
// values of a variable.
std::shared_ptr<const OceanField> read_ocean_field(const FieldQuery& query);

// Where in a grid of water, and in which files.
struct ColumnQuery {
  std::string temperature_path;
  std::string salinity_path = {};  // empty: the same file
  double latitude_rad = 0;         // -pi/2..pi/2
  double longitude_rad = 0;        // any number of turns
  int time_index = 0;              // of a file with several times, from 0
};

inline constexpr double kFarthestColumn = 300'000;  // m; farther water does not stand for this place

struct WaterColumn {
  std::vector<WaterAtDepth> rows;                      // depths rise, down to the deepest value
  double nearest_latitude_rad, nearest_longitude_rad;  // of the nearest column with water; longitude -pi..pi
  double distance_m;                                   // of that, on a sphere
};

// The water at a place as a field of the same file has it (OceanField::column_at); beyond the grid and among
// land that of the nearest column with water. Reads no more than what lies within kFarthestColumn. Throws as
// read_ocean_field does, and where no water is as near as that, or there is no such time.
WaterColumn read_water_column(const ColumnQuery& query);

// What the module exports as halocline_read_ocean_field and halocline_read_water_column; the caller owns the
// result.
using OceanFieldReader = OceanField*(const FieldQuery& query);
using WaterColumnReader = WaterColumn*(const ColumnQuery& query);

}  // namespace halocline::ocean
