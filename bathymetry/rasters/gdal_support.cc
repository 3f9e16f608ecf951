// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/gdal_support.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include <cpl_conv.h>

#include "bathymetry/rasters/gdal_access.h"
#include "core/check.h"
#include "ocean/cf_units.h"

namespace halocline::bathymetry::gdal {
namespace {

// Keeps GDAL's messages of this thread instead of printing them, while in scope.
class QuietErrors {
 public:
  QuietErrors() {
    CPLErrorReset();
    CPLPushErrorHandler(CPLQuietErrorHandler);
  }
  ~QuietErrors() { CPLPopErrorHandler(); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
  std::string last() const { return CPLGetLastErrorMsg(); }
};

// Collects GDAL's warnings of this thread while in scope.
class CollectedWarnings {
 public:
  explicit CollectedWarnings(std::vector<std::string>& warnings) {
    CPLErrorReset();
    CPLPushErrorHandlerEx(collect, &warnings);
  }
  ~CollectedWarnings() { CPLPopErrorHandler(); }
  CollectedWarnings(const CollectedWarnings&) = delete;
  CollectedWarnings& operator=(const CollectedWarnings&) = delete;

 private:
  static void CPL_STDCALL collect(CPLErr kind, CPLErrorNum, const char* text) {
    auto& warnings = *static_cast<std::vector<std::string>*>(CPLGetErrorHandlerUserData());
    if (kind == CE_Warning && std::find(warnings.begin(), warnings.end(), text) == warnings.end())
      warnings.emplace_back(text);
  }
};

Dataset open_one(const std::string& path, bool rows_as_stored, std::vector<std::string>& warnings) {
  const CollectedWarnings collected(warnings);
  if (rows_as_stored) CPLSetThreadLocalConfigOption("GDAL_NETCDF_BOTTOMUP", "NO");
  Dataset dataset(GDALDataset::FromHandle(
      GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, allowed_drivers(), nullptr, nullptr)));
  if (rows_as_stored) CPLSetThreadLocalConfigOption("GDAL_NETCDF_BOTTOMUP", nullptr);
  const std::string reason = CPLGetLastErrorMsg();
  require(dataset != nullptr, "cannot read the raster '" + path +
                                  "': " + (reason.empty() ? "it is of no format that is read" : reason));
  return dataset;
}

// Returns the paths of the rasters inside a file by their names, which end the paths.
std::map<std::string, std::string> parts_of(GDALDataset& dataset) {
  std::map<std::string, std::string> parts;
  char** metadata = dataset.GetMetadata("SUBDATASETS");
  for (int n = 1;; ++n) {
    const char* path = CSLFetchNameValue(metadata, ("SUBDATASET_" + std::to_string(n) + "_NAME").c_str());
    if (path == nullptr) return parts;
    const std::string text(path);
    parts[text.substr(text.find_last_of(":/") + 1)] = text;
  }
}

std::string names_of(const std::map<std::string, std::string>& parts) {
  std::string names;
  for (const auto& [name, path] : parts) names += (names.empty() ? "" : ", ") + name;
  return names;
}

double metres_in(const std::string& unit) {
  const std::optional<ocean::UnitFactor> factor = ocean::unit_in(ocean::QuantityKind::kLength, unit);
  require(factor || unit.empty() || unit == "unknown",
          "the raster's unit '" + unit + "' is no length; allowed are " +
              ocean::allowed_units(ocean::QuantityKind::kLength));
  return factor ? factor->factor : 1;
}

}  // namespace

Dataset open(const std::string& path, const std::string& variable, bool rows_as_stored,
             std::vector<std::string>& warnings) {
  prepare_access();
  require_allowed(path);
  Dataset dataset = open_one(path, rows_as_stored, warnings);
  const auto parts = parts_of(*dataset);
  if (variable.empty()) {
    require(dataset->GetRasterCount() > 0,
            "'" + path + "' holds several rasters; name a variable: " + names_of(parts));
    return dataset;
  }
  const auto part = parts.find(variable);
  if (part == parts.end() && dataset->GetRasterCount() > 0) {
    const char* only = dataset->GetRasterBand(1)->GetMetadataItem("NETCDF_VARNAME");
    require(only != nullptr && variable == only, "'" + path + "' has no variable '" + variable + "'");
    return dataset;
  }
  require(part != parts.end(),
          "'" + path + "' has no variable '" + variable + "'; it has " + names_of(parts));
  return open_one(part->second, rows_as_stored, warnings);
}

Transformation transformation_from_wgs84(const OGRSpatialReference& system) {
  const QuietErrors quiet;
  OGRSpatialReference wgs84;
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference target(system);
  target.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  target.StripVertical();  // the vertical datum is recorded and offset, never transformed
  if (target.IsSame(&wgs84) != 0) return nullptr;
  Transformation transformation(OGRCreateCoordinateTransformation(&wgs84, &target));
  require(transformation != nullptr,
          "PROJ knows no way into the raster's coordinate system: " + quiet.last());
  return transformation;
}

std::string vertical_datum_of(const OGRSpatialReference& system) {
  for (const char* node : {"VERT_CS|VERT_DATUM", "COMPD_CS|VERT_CS|VERT_DATUM", "VERT_CS"}) {
    const char* name = system.GetAttrValue(node);
    if (name != nullptr) return name;
  }
  return {};
}

void read_floats(GDALRasterBand& band, const Rectangle& r, float* out, std::size_t row_length) {
  const QuietErrors quiet;
  const CPLErr result =
      band.RasterIO(GF_Read, r.first_column, r.first_row, r.columns, r.rows, out, r.columns, r.rows,
                    GDT_Float32, sizeof(float), static_cast<GSpacing>(row_length * sizeof(float)), nullptr);
  require(result == CE_None, "cannot read from the raster: " + quiet.last());
}

std::vector<unsigned char> read_mask(GDALRasterBand& band, const Rectangle& r) {
  if ((band.GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA)) != 0) return {};
  const QuietErrors quiet;
  std::vector<unsigned char> mask(static_cast<std::size_t>(r.columns) * static_cast<std::size_t>(r.rows));
  const CPLErr result = band.GetMaskBand()->RasterIO(GF_Read, r.first_column, r.first_row, r.columns, r.rows,
                                                     mask.data(), r.columns, r.rows, GDT_Byte, 0, 0, nullptr);
  require(result == CE_None, "cannot read the raster's mask: " + quiet.last());
  return mask;
}

bool BandMeaning::is_no_data(float raw) const {
  return !std::isfinite(raw) || std::find(no_data.begin(), no_data.end(), raw) != no_data.end();
}

BandMeaning meaning_of(GDALRasterBand& band, std::optional<double> extra) {
  BandMeaning meaning;
  int has = 0;
  const double declared = band.GetNoDataValue(&has);
  if (has != 0) meaning.no_data.push_back(static_cast<float>(declared));
  for (const char* key : {"missing_value", "_FillValue"}) {
    const char* text = band.GetMetadataItem(key);
    if (text != nullptr) meaning.no_data.push_back(std::strtof(text, nullptr));
  }
  if (extra) meaning.no_data.push_back(static_cast<float>(*extra));
  meaning.scale = band.GetScale();
  meaning.offset = band.GetOffset();
  meaning.metres_a_unit = metres_in(band.GetUnitType());
  return meaning;
}

}  // namespace halocline::bathymetry::gdal
