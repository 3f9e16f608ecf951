// SPDX-License-Identifier: BSD-3-Clause
// Reads sound-speed profiles from files: the one place of this folder that touches a file.
//
// CSV (tables and CTD casts): a header names the columns, in any order; others are ignored. Either
//   depth_m, temperature_degC, salinity_psu     in-situ temperature (ITS-90) and practical salinity, or
//   depth_m, CT_degC, SA_g_per_kg               conservative temperature and absolute salinity (TEOS-10), or
//   depth_m, sound_speed_mps                    speed alone.
// Depths must rise: one that repeats or turns back is refused with its line, and a cast that goes down and up
// with the lines of either leg, of which a person keeps one. Of many faults the first five are reported, and
// how many more there are.
//
// CF netCDF (World Ocean Atlas, Levitus, models): the column of an ocean field at a position
// (ocean/ocean_field_reader.h), with all that its reader converts and refuses.
//
// Calls may overlap between threads.
#pragma once

#include <iosfwd>
#include <string>

#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "ocean/ocean_field_reader.h"

namespace halocline::acoustics {

// What turns a table into speed.
struct ProfileReading {
  SoundSpeedModel model =
      SoundSpeedModel::kMackenzie1981;       // ignored by tables of speed; TEOS-10 by SA and CT only
  double latitude_rad = 0.7853981633974483;  // for models of pressure, -pi/2..pi/2; default 45 degrees
  WaterSample assumed{10, 35};               // temperature and salinity of tables of speed
};

// From CSV text. `name` appears in messages. Throws InvalidArgument with every fault, a line each.
SoundSpeedProfile read_csv_profile(std::istream& in, const std::string& name, const ProfileReading& reading);

using GridQuery = ocean::ColumnQuery;

struct GridProfile {
  SoundSpeedProfile profile;
  double column_latitude_rad;   // of the nearest column with water
  double column_longitude_rad;  // -pi..pi
  double distance_m;            // from the place given, on a sphere
  int levels;                   // rows of the profile
  std::string description;      // one line that states all this
};

// Throws InvalidArgument as ocean::read_water_column does.
GridProfile read_grid_profile(const GridQuery& query, SoundSpeedModel model);

// By the ending of `path`: .csv and .txt are tables, all else is netCDF.
bool is_profile_table(const std::string& path);

// A table, or netCDF at the position (then the latitude of `reading` is the query's). Throws InvalidArgument
// when the file cannot be read.
SoundSpeedProfile read_profile(const std::string& path, const ProfileReading& reading, double latitude_rad,
                               double longitude_rad);

}  // namespace halocline::acoustics
