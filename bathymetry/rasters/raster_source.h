// SPDX-License-Identifier: BSD-3-Clause
// One band of a raster file, opened with GDAL: where its posts lie, and its depths, window by window.
//
// Posts are addressed as (column, row), 0 to size - 1, at their own place: a pixel's centre, or the node. The
// traps that this class is for:
// - global rasters whose pixel edges pass the poles, or whose longitudes run 0..360: longitudes are unwrapped
//   around the scenario, columns taken modulo a turn, nothing is warped as a whole;
// - a longitude axis whose step is rounded (ETOPO5 drifts by 0.0033 degrees over the globe): a raster that
// goes
//   round the earth gets the step 360 / columns;
// - NoData: declared values, netCDF fills, masks, NaN; values no sea or mountain has; and undeclared marks
//   (suspect_values.h);
// - axes of netCDF that are unevenly spaced (netcdf_raster_source.h);
// - scale and offset of the band; feet; rows that run either way.
// Only windows are read, so a global 15 arc-second grid costs what the scenario covers of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bathymetry/rasters/raster_options.h"
#include "core/huge_page_vector.h"

namespace halocline::bathymetry {

// A place between posts: column and row, fractions included.
struct PixelPosition {
  double column = 0, row = 0;
};

// Posts first_column .. first_column + columns - 1 (which may run past a turn of a global raster), and rows
// so.
struct RasterWindow {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
  HugePageVector<float>
      depths_m;  // positive down from the file's zero plus the offset; NaN no data; row by row

  // Bilinear over the posts around; NaN when one that counts is NaN, and beyond the window: nothing bleeds,
  // nothing is extrapolated.
  double depth_at(const PixelPosition& at) const;
};

struct PostCounts {
  std::size_t declared_no_data = 0;    // as the file or the options declare
  std::size_t undeclared_no_data = 0;  // recognised as stated above
};

class RasterSource {
 public:
  // Opens a raster with GDAL, which the first call loads (0.1 s). origin_latitude_deg, origin_longitude_deg:
  // of the scenario, around which longitudes are unwrapped. Throws InvalidArgument with GDAL's words when the
  // file cannot be read, when it lacks what options must state, and when GDAL cannot be loaded.
  static std::unique_ptr<RasterSource> open(const RasterOptions& options, double origin_latitude_deg,
                                            double origin_longitude_deg);
  virtual ~RasterSource() = default;

  virtual int columns() const = 0;
  virtual int rows() const = 0;
  virtual bool is_local() const = 0;  // its coordinates are metres east and north of the scenario's origin

  // Of a place on the earth (degrees, WGS84); NaN where the raster's projection has none. Not for local
  // rasters.
  virtual PixelPosition pixel_at(double latitude_deg, double longitude_deg) const = 0;
  // Of metres east and north of the origin; only for local rasters.
  virtual PixelPosition pixel_at_local(double north_m, double east_m) const = 0;
  // Only for local rasters: the south-western post and the distance of posts. Throws unless pixels are square
  // and the axes unrotated.
  struct LocalPosts {
    double first_north_m = 0, first_east_m = 0, spacing_m = 0;
    bool south_first = false;
  };
  virtual LocalPosts local_posts() const = 0;

  // The part of the raster within one post around low..high, empty (0 columns) where they do not meet.
  virtual RasterWindow read(const PixelPosition& low, const PixelPosition& high,
                            PostCounts& counts) const = 0;

  virtual std::vector<std::string> warnings() const = 0;  // said while it was opened
  virtual std::string coordinate_system() const = 0;      // by name
  virtual std::string vertical_datum() const = 0;
};

// What the module halocline_rasters.so exports as halocline_open_raster; the caller owns the result.
using RasterOpener = RasterSource*(const RasterOptions& options, double origin_latitude_deg,
                                   double origin_longitude_deg);

}  // namespace halocline::bathymetry
