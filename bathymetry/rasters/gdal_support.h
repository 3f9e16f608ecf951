// SPDX-License-Identifier: BSD-3-Clause
// Wrapper of the GDAL functions that the loader uses, with errors as exceptions and owned objects.
//
// GDAL prints errors and returns codes; here a failure throws InvalidArgument with GDAL's own words. Every
// call may be made from any thread, but one dataset only from one thread at a time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

namespace halocline::bathymetry::gdal {

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

struct TransformationDestroyer {
  void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
};
using Transformation = std::unique_ptr<OGRCoordinateTransformation, TransformationDestroyer>;

// Opens a raster read-only, as gdal_access.h allows. `variable` selects one of several in a netCDF or HDF
// file; empty when there is one. `rows_as_stored`: netCDF rows come in the file's order instead of north
// first. GDAL's warnings are appended to `warnings`.
Dataset open(const std::string& path, const std::string& variable, bool rows_as_stored,
             std::vector<std::string>& warnings);

// Returns the transformation from WGS84 (longitude, latitude in degrees) to the system (its x, y; degrees as
// longitude, latitude); null when the two are the same.
Transformation transformation_from_wgs84(const OGRSpatialReference& system);

// Returns the name of the vertical datum or system; empty when none is declared.
std::string vertical_datum_of(const OGRSpatialReference& system);

struct Rectangle {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
};

// Reads raw values of the band, row by row; `row_length` is the number of floats from one row of `out` to the
// next.
void read_floats(GDALRasterBand& band, const Rectangle& rectangle, float* out, std::size_t row_length);

// Returns the mask of the band, 0 where it marks no data; empty when the band has no mask.
std::vector<unsigned char> read_mask(GDALRasterBand& band, const Rectangle& rectangle);

// Interpretation of the band's numbers.
struct BandMeaning {
  double scale = 1, offset = 0;  // to the declared unit
  double metres_a_unit = 1;
  std::vector<float> no_data = {};  // raw values, rounded to the band's type

  bool is_no_data(float raw) const;
  double metres(float raw) const { return (scale * double{raw} + offset) * metres_a_unit; }
};

// Returns the declared NoData value, missing_value, _FillValue and `extra`; scale, offset and unit. Throws
// InvalidArgument for a unit that is not one of length.
BandMeaning meaning_of(GDALRasterBand& band, std::optional<double> extra);

}  // namespace halocline::bathymetry::gdal
