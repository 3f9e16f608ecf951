// SPDX-License-Identifier: BSD-3-Clause
// Options of a depth raster: its location, and whatever the file itself does not state.
//
// The declarations of a file are trusted, and what it does not declare is not guessed: a raster without a
// coordinate system or a position is refused with the option that would supply it. Exceptions are stated
// below.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "core/files/file_path.h"

namespace halocline::bathymetry {

// Position of the outermost posts relative to the bounds that the file declares.
enum class Registration {
  kAsDeclared,  // posts are pixel centres, half a pixel inside the bounds (as GDAL reads each format)
  kNode         // the first and last posts lie on the bounds themselves
};

enum class RowOrder { kNorthFirst, kSouthFirst };

// Bounds for a raster without any, in units of its coordinate system (degrees east / north, or metres).
struct RasterBounds {
  double west = 0, south = 0, east = 0,
         north = 0;                            // pixel edges (see Registration); west < east, south < north
  RowOrder row_order = RowOrder::kNorthFirst;  // order of the rows in the file
};

// True where the user lets a raster be anything that GDAL opens, including servers and virtual files:
// `halocline --any-raster` sets HALOCLINE_ANY_RASTER for the programs that it starts.
inline constexpr const char* kAnyRaster = "HALOCLINE_ANY_RASTER";
inline bool is_any_raster_allowed() { return std::getenv(kAnyRaster) != nullptr; }

struct RasterOptions {
  FilePath path = {};         // path of a file
  std::string variable = {};  // one of several in a netCDF or HDF file; empty: the only 2D one
  int band = 1;               // from 1

  bool positive_down = false;          // the file holds depths without declaring it; the report counts land
  std::optional<double> no_data = {};  // one more value that means no data, before scaling
  bool trust_every_value = false;      // true: no value is suspected of being undeclared no data

  Registration registration = Registration::kAsDeclared;
  std::optional<RasterBounds> bounds = {};  // only for a raster without a geotransform
  // Coordinate system of a raster that names none: anything PROJ knows ("EPSG:4326"), or "local" for metres
  // east and north of the scenario's origin. When empty, such a raster is taken as degrees if it then
  // contains the scenario's origin, and refused otherwise.
  std::string coordinate_system = {};

  std::string vertical_datum = {};  // "LAT", "EGM2008", ...; empty: as the file states, else "unstated"
  double datum_offset_m = 0;        // added to every depth: how far the file's zero lies below the scenario's
};

}  // namespace halocline::bathymetry
