// SPDX-License-Identifier: BSD-3-Clause
// Reads sound-speed profiles from files: the one place of this folder that touches a file.
//
// CSV (tables and CTD casts): a header names the columns, in any order; others are ignored. Either
//   depth_m, temperature_degC, salinity_psu     in-situ temperature (ITS-90) and practical salinity, or
//   depth_m, CT_degC, SA_g_per_kg               conservative temperature and absolute salinity (TEOS-10), or
//   depth_m, sound_speed_mps                    speed alone.
// Rows need not be sorted by the file's author: they must be, and a depth that repeats or turns back is
// refused with its line, since a cast's up and down legs must be separated by a person. All faults are
// reported at once.
//
// CF netCDF (World Ocean Atlas t_an/s_an, Levitus TEMP/SALT, ...): the column of water at a position. The
// grid is not interpolated: the nearest column whose surface holds both temperature and salinity is used
// (fill values never are) down to its first fill value, and the result states which column it is and how far
// away.
//
// GDAL is in a module of its own (halocline_profile_grids.so), loaded by the first grid. Calls may overlap between
// threads.
#pragma once

#include <iosfwd>
#include <string>

#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"

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

// Where in a gridded climatology, and in which of its files.
struct GridQuery {
  std::string temperature_path;  // netCDF
  std::string salinity_path;     // empty: the same file
  double latitude_rad = 0;       // -pi/2..pi/2
  double longitude_rad = 0;      // any number of turns
  int time_index = 0;            // of a file with several times, from 0
};

struct GridProfile {
  SoundSpeedProfile profile;
  double column_latitude_rad;   // of the column used
  double column_longitude_rad;  // -pi..pi
  double distance_m;            // from the place given, on a sphere
  int levels;                   // rows of the profile
  std::string description;      // one line that states all this
};

// The first call loads GDAL (0.1 s). Throws InvalidArgument when the file has no such variables, no such time, or no
// valid column within kFarthestColumn of the position, and when GDAL cannot be loaded.
GridProfile read_grid_profile(const GridQuery& query, SoundSpeedModel model);

// What the module halocline_profile_grids.so exports as halocline_read_grid_profile; the caller owns the result.
using GridProfileReader = GridProfile*(const GridQuery& query, SoundSpeedModel model);

inline constexpr double kFarthestColumn = 300'000;  // m; farther water does not stand for this place

// By the ending of `path`: .csv and .txt as a table, anything else as netCDF at the position (then the
// latitude of `reading` is the query's). Throws InvalidArgument when the file cannot be read.
SoundSpeedProfile read_profile(const std::string& path, const ProfileReading& reading, double latitude_rad,
                               double longitude_rad);

}  // namespace halocline::acoustics
