// SPDX-License-Identifier: BSD-3-Clause
// Reads sound-speed profiles from files; the only file access in this folder.
//
// CSV (tables and CTD casts): a header names the columns, in any order; other columns are ignored. One of
// these sets is needed:
//   depth_m, temperature_degC, salinity_psu     in-situ temperature (ITS-90) and practical salinity
//   depth_m, CT_degC, SA_g_per_kg               conservative temperature and absolute salinity (TEOS-10)
//   depth_m, sound_speed_mps                    sound speed alone
// Depths must increase. A depth that repeats or decreases is reported with its line; for a cast that goes
// down and up the lines of both legs are reported, of which the user keeps one. The first five faults are
// reported, and the number of further ones.
//
// CF netCDF (World Ocean Atlas, Levitus, ocean models): the column of a field at a position, with the
// conversions and errors of its reader (ocean/ocean_field_reader.h).
//
// Calls may overlap between threads.
#pragma once

#include <iosfwd>
#include <string>

#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "ocean/ocean_field_reader.h"

namespace halocline::acoustics {

// Parameters by which a table is converted to sound speed.
struct ProfileReading {
  // Ignored by tables of sound speed; TEOS-10 needs SA and CT.
  SoundSpeedModel model = SoundSpeedModel::kMackenzie1981;
  double latitude_rad = 0.7853981633974483;  // -pi/2..pi/2, for models that use pressure; default 45 degrees
  WaterSample assumed{10, 35};               // temperature and salinity for tables of sound speed
};

// Reads CSV text. `name` appears in messages. Throws InvalidArgument with the faults, one line each.
SoundSpeedProfile read_csv_profile(std::istream& in, const std::string& name, const ProfileReading& reading);

using GridQuery = ocean::ColumnQuery;

// A profile from a gridded field, and the column that it was taken from.
struct GridProfile {
  SoundSpeedProfile profile;
  double column_latitude_rad;   // nearest column with water, -pi/2..pi/2
  double column_longitude_rad;  // nearest column with water, -pi..pi
  double distance_m;            // distance of that column from the given position, on a sphere
  int levels;                   // rows of the profile
  std::string description;      // summary of these values in one line
};

// The profile at a position. Throws InvalidArgument under the conditions of ocean::read_water_column(), and
// for TEOS-10.
GridProfile read_grid_profile(const GridQuery& query, SoundSpeedModel model);

// True for paths that end in .csv or .txt, which are tables; all others are netCDF.
bool is_profile_table(const std::string& path);

// Reads a table, or netCDF at the given position, whose latitude then replaces that of `reading`. Throws
// InvalidArgument when the file cannot be read.
SoundSpeedProfile read_profile(const std::string& path, const ProfileReading& reading, double latitude_rad,
                               double longitude_rad);

}  // namespace halocline::acoustics
