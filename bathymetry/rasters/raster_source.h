// SPDX-License-Identifier: BSD-3-Clause
// One band of a raster file, opened with GDAL: the positions of its posts, and its depths, window by window.
//
// Posts are addressed by (column, row), 0 to size - 1, at their own positions: pixel centres, or nodes. This
// class handles the pitfalls of such files:
// - Global rasters whose pixel edges pass the poles, or whose longitudes run 0..360: longitudes are unwrapped
//   around the scenario, columns are taken modulo a turn, and nothing is warped as a whole.
// - Longitude axes with a rounded step (ETOPO5 drifts by 0.0033 degrees over the globe): a raster that spans
//   the earth gets the step 360 / columns.
// - NoData: declared values, netCDF fill values, masks, NaN, values beyond any sea or mountain, and
//   undeclared marks (suspect_values.h).
// - Unevenly spaced netCDF axes (netcdf_raster_source.h).
// - Scale and offset of the band; feet; rows in either direction.
//
// Only windows are read, so the cost of a global 15 arc-second grid is that of the part under the scenario.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bathymetry/rasters/raster_options.h"
#include "core/huge_page_vector.h"

namespace halocline::bathymetry {

// Position among posts: column and row, with fractions.
struct PixelPosition {
  double column = 0, row = 0;
};

// Posts first_column .. first_column + columns - 1, which may run past a full turn of a global raster, and
// rows first_row .. first_row + rows - 1.
struct RasterWindow {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
  HugePageVector<float>
      depths_m;  // from the file's zero plus the offset, positive down; NaN: no data; row by row

  // Returns the bilinear interpolation of the posts around; NaN when a post with weight is NaN, and beyond
  // the window. Data is neither spread nor extrapolated.
  double depth_at(const PixelPosition& at) const;
};

struct PostCounts {
  std::size_t declared_no_data = 0;    // declared by the file or the options
  std::size_t undeclared_no_data = 0;  // recognised by the rules above
};

class RasterSource {
 public:
  // Opens a raster with GDAL, which the first call loads (0.1 s). Longitudes are unwrapped around the
  // scenario's origin. Throws InvalidArgument with GDAL's words when the file cannot be read, when it lacks
  // what options must state, and when GDAL cannot be loaded.
  static std::unique_ptr<RasterSource> open(const RasterOptions& options, double origin_latitude_deg,
                                            double origin_longitude_deg);
  virtual ~RasterSource() = default;

  virtual int columns() const = 0;
  virtual int rows() const = 0;
  virtual bool is_local() const = 0;  // coordinates are metres east and north of the scenario's origin

  // Returns the pixel position of a geodetic position (degrees, WGS84); NaN where the raster's projection is
  // undefined. Not for local rasters.
  virtual PixelPosition pixel_at(double latitude_deg, double longitude_deg) const = 0;
  // Returns the pixel position of a position in metres north and east of the origin; only for local rasters.
  virtual PixelPosition pixel_at_local(double north_m, double east_m) const = 0;
  // Returns the south-western post and the distance of posts; only for local rasters. Throws unless pixels
  // are square and the axes unrotated.
  struct LocalPosts {
    double first_north_m = 0, first_east_m = 0, spacing_m = 0;
    bool south_first = false;
  };
  virtual LocalPosts local_posts() const = 0;

  // Reads the part of the raster within one post around low..high; empty (0 columns) where they do not meet.
  virtual RasterWindow read(const PixelPosition& low, const PixelPosition& high,
                            PostCounts& counts) const = 0;

  virtual std::vector<std::string> warnings() const = 0;  // from opening the file
  virtual std::string coordinate_system() const = 0;      // name of the system
  virtual std::string vertical_datum() const = 0;
};

// Type of the function halocline_open_raster that the module halocline_rasters.so exports; the caller owns
// the result.
using RasterOpener = RasterSource*(const RasterOptions& options, double origin_latitude_deg,
                                   double origin_longitude_deg);

}  // namespace halocline::bathymetry
