// SPDX-License-Identifier: BSD-3-Clause
// Options of a raster of depths: where it is, and whatever the file itself does not state.
//
// Files are trusted where they speak and never guessed at where they do not: a raster that lacks a coordinate
// system or a place in the world is refused with the option that would supply it. The exceptions are stated.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "core/files/file_path.h"

namespace halocline::bathymetry {

// Where the outermost posts lie relative to the bounds that the file declares.
enum class Registration {
  kAsDeclared,  // posts are pixel centres, half a pixel inside the bounds (and GDAL's reading of each format)
  kNode         // the first and last posts lie on the bounds themselves
};

enum class RowOrder { kNorthFirst, kSouthFirst };

// Bounds of a raster that has none, in units of its coordinate system (degrees east / north, or metres).
struct RasterBounds {
  double west = 0, south = 0, east = 0,
         north = 0;  // west < east, south < north; of pixel edges (see Registration)
  RowOrder row_order = RowOrder::kNorthFirst;  // of the rows as the file stores them
};

// True where the user lets a raster be anything that GDAL opens, servers and virtual files among it: by
// `halocline --any-raster`, which sets HALOCLINE_ANY_RASTER for the programs that it starts.
inline constexpr const char* kAnyRaster = "HALOCLINE_ANY_RASTER";
inline bool is_any_raster_allowed() { return std::getenv(kAnyRaster) != nullptr; }

struct RasterOptions {
  FilePath path = {};         // of a file
  std::string variable = {};  // of a netCDF or HDF file with several; empty: the only one with two dimensions
  int band = 1;               // from 1

  bool positive_down =
      false;  // the file holds depths, and does not say so itself; the report says how much is land
  std::optional<double> no_data = {};  // a value to take as no data beside the declared ones, before scaling
  bool trust_every_value = false;      // no value is suspected of being undeclared no data

  Registration registration = Registration::kAsDeclared;
  std::optional<RasterBounds> bounds = {};  // only for a raster without a geotransform
  // For a raster that names no coordinate system: anything PROJ knows ("EPSG:4326"), or "local": metres east
  // and north of the scenario's origin. Without it, such a raster is taken as degrees when, so read, it holds
  // the scenario's origin, and refused otherwise.
  std::string coordinate_system = {};

  std::string vertical_datum = {};  // "LAT", "EGM2008", ...; empty: what the file states, else "unstated"
  double datum_offset_m = 0;        // added to every depth: how far the file's zero lies below the scenario's
};

}  // namespace halocline::bathymetry
