// SPDX-License-Identifier: BSD-3-Clause
// Coverage maps as GeoTIFF and as contours in GeoJSON, written through GDAL. Part of the module
// halocline_coverage_files.so, which only coverage_files.cc loads.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include "channel_server/propagation/propagation.h"
#include "core/atomic_file.h"
#include "core/elementary.h"
#include "simulation/coverage/coverage.h"
#include "simulation/coverage/coverage_files.h"

namespace halocline::clients {
namespace {

struct Closer {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error("cannot write " + path + ": " + CPLGetLastErrorMsg());
}

void checked(bool is_done, const std::string& path) {
  if (!is_done) fail(path);
}

GDALDriver& driver(const char* name) {
  GDALAllRegister();
  GDALDriver* found = GetGDALDriverManager()->GetDriverByName(name);
  if (found == nullptr) throw std::runtime_error(std::string("GDAL has no driver ") + name);
  return *found;
}

OGRSpatialReference system_of(const CoverageFile& file) {
  OGRSpatialReference system;
  if (system.SetFromUserInput(reference_system(file.frame).c_str()) != OGRERR_NONE)
    throw std::runtime_error("GDAL knows no " + reference_system(file.frame));
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

Dataset raster(GDALDriver& kind, const std::string& path, const Coverage& coverage, std::size_t bands,
               const CoverageFile& file, char** options) {
  const CoverageArea& area = coverage.area;
  const int side = static_cast<int>(area.side);
  Dataset dataset(kind.Create(path.c_str(), side, side, static_cast<int>(bands), GDT_Float32, options));
  if (!dataset) fail(path);
  const double north_m = area.south_m() + static_cast<double>(area.side) * area.cell_m;
  double transform[6] = {area.west_m(), area.cell_m, 0, north_m, 0, -area.cell_m};
  checked(dataset->SetGeoTransform(transform) == CE_None, path);
  const OGRSpatialReference system = system_of(file);
  checked(dataset->SetSpatialRef(&system) == CE_None, path);
  return dataset;
}

// Writes rows that start in the south to a band, whose rows start in the north.
void put(GDALRasterBand& band, const std::vector<double>& values, std::size_t side, const std::string& path) {
  for (std::size_t row = 0; row < side; ++row) {
    std::vector<double> line(values.begin() + static_cast<std::ptrdiff_t>(row * side),
                             values.begin() + static_cast<std::ptrdiff_t>((row + 1) * side));
    checked(band.RasterIO(GF_Write, 0, static_cast<int>(side - 1 - row), static_cast<int>(side), 1,
                          line.data(), static_cast<int>(side), 1, GDT_Float64, 0, 0, nullptr) == CE_None,
            path);
  }
}

void write_geotiff(const Coverage& coverage, const CoverageFile& file, const std::string& path) {
  AtomicFile replacement(path);
  const std::vector<double>& depths = coverage.area.depths_m;
  char compress[] = "COMPRESS=DEFLATE", tiled[] = "TILED=YES";
  char* options[] = {compress, tiled, nullptr};
  const std::string temporary = replacement.temporary_path();
  Dataset dataset =
      raster(driver("GTiff"), temporary, coverage, file.quantities.size() * depths.size(), file, options);
  dataset->SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", file.title.c_str());
  int number = 0;
  for (const CoverageQuantity quantity : file.quantities) {
    const QuantityMeaning& meaning = meaning_of(quantity);
    for (std::size_t depth = 0; depth < depths.size(); ++depth) {
      GDALRasterBand& band = *dataset->GetRasterBand(++number);
      band.SetNoDataValue(std::nan(""));
      band.SetDescription(fmt::format("{} at {:g} m", meaning.name, depths[depth]).c_str());
      band.SetUnitType(meaning.unit);
      band.SetMetadataItem("depth_m", fmt::format("{:g}", depths[depth]).c_str());
      put(band, coverage.values(quantity, depth), coverage.area.side, temporary);
    }
  }
  CPLErrorReset();
  dataset.reset();
  checked(CPLGetLastErrorType() < CE_Failure, path);
  replacement.commit();
}

// Returns the values of contour lines: round numbers between the minimum and the maximum, ignoring cells
// without sound.
std::vector<double> contour_levels(CoverageQuantity quantity, const std::vector<double>& values) {
  if (meaning_of(quantity).unit == std::string_view("1")) return {0.1, 0.25, 0.5, 0.75, 0.9};
  double least = INFINITY, greatest = -INFINITY;
  for (const double value : values) {
    if (std::isnan(value) || value <= channel_server::kSilence.value / 2) continue;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  std::vector<double> levels;
  if (!(greatest > least)) return levels;
  constexpr double kFewest = 5;
  const double power = elementary::exp10(std::floor(elementary::log10((greatest - least) / kFewest)));
  const double ratio = (greatest - least) / kFewest / power;
  const double step = power * (ratio >= 5 ? 5 : ratio >= 2 ? 2 : 1);
  for (double level = std::ceil(least / step) * step; level <= greatest; level += step)
    levels.push_back(level);
  return levels;
}

struct ContourFields {
  static constexpr int kValue = 0, kDepth = 1, kQuantity = 2;
  static void define(OGRLayer& layer) {
    OGRFieldDefn value("value", OFTReal), depth("depth_m", OFTReal), quantity("quantity", OFTString);
    for (OGRFieldDefn* field : {&value, &depth, &quantity}) layer.CreateField(field);
  }
};

// Adds the contours of one quantity at one depth, in the local frame.
void add_contours(const Coverage& coverage, const CoverageFile& file, CoverageQuantity quantity,
                  std::size_t depth, OGRLayer& out, OGRCoordinateTransformation& to_wgs84,
                  const std::string& path) {
  constexpr double kNoData = -1e30;
  std::vector<double> values = coverage.values(quantity, depth);
  std::string levels;
  for (const double level : contour_levels(quantity, values)) levels += fmt::format("{},", level);
  if (levels.empty()) return;
  levels.pop_back();
  for (double& value : values) {
    if (std::isnan(value)) value = kNoData;
  }
  const Dataset map = raster(driver("MEM"), "", coverage, 1, file, nullptr);
  put(*map->GetRasterBand(1), values, coverage.area.side, path);
  const Dataset lines(driver("Memory").Create("", 0, 0, 0, GDT_Unknown, nullptr));
  OGRLayer* layer = lines->CreateLayer("lines", nullptr, wkbLineString, nullptr);
  ContourFields::define(*layer);
  char** options = CSLSetNameValue(nullptr, "FIXED_LEVELS", levels.c_str());
  options = CSLSetNameValue(options, "ELEV_FIELD", "0");
  options = CSLSetNameValue(options, "NODATA", fmt::format("{}", kNoData).c_str());
  const bool done = GDALContourGenerateEx(map->GetRasterBand(1), OGRLayer::ToHandle(layer), options, nullptr,
                                          nullptr) == CE_None;
  CSLDestroy(options);
  checked(done, path);
  for (auto& feature : *layer) {
    feature->SetField(ContourFields::kDepth, coverage.area.depths_m[depth]);
    feature->SetField(ContourFields::kQuantity, meaning_of(quantity).name);
    checked(feature->GetGeometryRef()->transform(&to_wgs84) == OGRERR_NONE, path);
    feature->SetFID(OGRNullFID);
    checked(out.CreateFeature(feature.get()) == OGRERR_NONE, path);
  }
}

void write_geojson(const Coverage& coverage, const CoverageFile& file, const std::string& path) {
  AtomicFile replacement(path);
  const std::string temporary = replacement.temporary_path();
  Dataset dataset(driver("GeoJSON").Create(temporary.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) fail(path);
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  char rfc[] = "RFC7946=YES";
  char* options[] = {rfc, nullptr};
  OGRLayer* layer = dataset->CreateLayer("coverage", &wgs84, wkbLineString, options);
  if (layer == nullptr) fail(path);
  ContourFields::define(*layer);
  const OGRSpatialReference system = system_of(file);
  const std::unique_ptr<OGRCoordinateTransformation> to_wgs84(
      OGRCreateCoordinateTransformation(&system, &wgs84));
  if (!to_wgs84) fail(path);
  for (const CoverageQuantity quantity : file.quantities) {
    for (std::size_t depth = 0; depth < coverage.area.depths_m.size(); ++depth)
      add_contours(coverage, file, quantity, depth, *layer, *to_wgs84, path);
  }
  CPLErrorReset();
  dataset.reset();
  checked(CPLGetLastErrorType() < CE_Failure, path);
  replacement.commit();
}

}  // namespace
}  // namespace halocline::clients

extern "C" halocline::clients::CoverageWriter halocline_write_coverage_geotiff,
    halocline_write_coverage_geojson;

void halocline_write_coverage_geotiff(const halocline::clients::Coverage& coverage,
                                      const halocline::clients::CoverageFile& file, const std::string& path) {
  halocline::clients::write_geotiff(coverage, file, path);
}

void halocline_write_coverage_geojson(const halocline::clients::Coverage& coverage,
                                      const halocline::clients::CoverageFile& file, const std::string& path) {
  halocline::clients::write_geojson(coverage, file, path);
}
