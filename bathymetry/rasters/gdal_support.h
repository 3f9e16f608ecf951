// SPDX-License-Identifier: BSD-3-Clause
// What the loader uses of GDAL, with errors as exceptions and objects owned.
//
// GDAL prints errors and returns codes; here a failure throws InvalidArgument with GDAL's own words. Every
// call may be made from any thread, but one dataset from one thread at a time.
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

// Opens a raster read-only, where gdal_access.h lets it. variable: which of several a netCDF or HDF file
// holds; empty when there is one. rows_as_stored: netCDF rows come in the file's order instead of north
// first. What GDAL warns of is added to `warnings`.
Dataset open(const std::string& path, const std::string& variable, bool rows_as_stored,
             std::vector<std::string>& warnings);

// From WGS84 (longitude, latitude in degrees) to the system (its x, y; degrees as longitude, latitude); null
// when they are the same.
Transformation transformation_from_wgs84(const OGRSpatialReference& system);

// The name of the vertical datum or system, empty when none is declared.
std::string vertical_datum_of(const OGRSpatialReference& system);

struct Rectangle {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
};

// Raw values of the band, row by row; row_length: floats from one row of `out` to the next.
void read_floats(GDALRasterBand& band, const Rectangle& rectangle, float* out, std::size_t row_length);

// 0 where the band's mask marks no data; empty when the band has no mask.
std::vector<unsigned char> read_mask(GDALRasterBand& band, const Rectangle& rectangle);

// What the band's numbers mean.
struct BandMeaning {
  double scale = 1, offset = 0;  // of the declared unit
  double metres_a_unit = 1;
  std::vector<float> no_data = {};  // raw values, as the band's type rounds them

  bool is_no_data(float raw) const;
  double metres(float raw) const { return (scale * double{raw} + offset) * metres_a_unit; }
};

// Declared NoData, missing_value, _FillValue and `extra`; scale, offset and unit. Throws for a unit that is
// no length.
BandMeaning meaning_of(GDALRasterBand& band, std::optional<double> extra);

}  // namespace halocline::bathymetry::gdal
