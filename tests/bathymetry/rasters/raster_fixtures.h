// SPDX-License-Identifier: BSD-3-Clause
// Small rasters in GDAL's memory file system, for the tests of the loader.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/local_frame.h"
#include "core/units.h"

namespace halocline::bathymetry::testing {

// A GeoTIFF to be. Heights are positive up as files have them.
struct TestRaster {
  std::string name;  // of the file, unique in the program
  int columns = 0, rows = 0;
  std::optional<std::array<double, 6>> geotransform = {};  // of pixel edges, as GDAL has it
  std::string coordinate_system = "EPSG:4326";             // empty: none
  std::optional<double> no_data = {};
  std::string unit = {};
  double scale = 1, offset = 0;
  GDALDataType type = GDT_Float32;
};

// Writes height(column, row) to /vsimem and returns the path.
inline std::string write_raster(const TestRaster& raster, const std::function<double(int, int)>& height) {
  GDALAllRegister();
  const std::string path = "/vsimem/" + raster.name + ".tif";
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  std::unique_ptr<GDALDataset, void (*)(GDALDataset*)> dataset(
      driver->Create(path.c_str(), raster.columns, raster.rows, 1, raster.type, nullptr),
      [](GDALDataset* d) { GDALClose(d); });
  if (raster.geotransform) {
    std::array<double, 6> geotransform = *raster.geotransform;
    dataset->SetGeoTransform(geotransform.data());
  }
  if (!raster.coordinate_system.empty()) {
    OGRSpatialReference system;
    system.SetFromUserInput(raster.coordinate_system.c_str());
    dataset->SetSpatialRef(&system);
  }
  GDALRasterBand* band = dataset->GetRasterBand(1);
  if (raster.no_data) band->SetNoDataValue(*raster.no_data);
  if (!raster.unit.empty()) band->SetUnitType(raster.unit.c_str());
  if (raster.scale != 1) band->SetScale(raster.scale);
  if (raster.offset != 0) band->SetOffset(raster.offset);
  std::vector<double> row(static_cast<std::size_t>(raster.columns));
  for (int r = 0; r < raster.rows; ++r) {
    for (int c = 0; c < raster.columns; ++c) row[static_cast<std::size_t>(c)] = height(c, r);
    const CPLErr result = band->RasterIO(GF_Write, 0, r, raster.columns, 1, row.data(), raster.columns, 1,
                                         GDT_Float64, 0, 0, nullptr);
    if (result != CE_None) throw std::runtime_error("cannot write " + path);
  }
  return path;
}

// Any text as a file of the memory file system; returns the path.
inline std::string write_text(const std::string& name, const std::string& text) {
  const std::string path = "/vsimem/" + name;
  VSILFILE* file = VSIFOpenL(path.c_str(), "wb");
  VSIFWriteL(text.data(), 1, text.size(), file);
  VSIFCloseL(file);
  return path;
}

// Float posts near 1000 m round by 3e-5 m.
inline constexpr double kFloatM = 1e-4;

inline LocalFrame frame_at(double latitude_deg, double longitude_deg, FrameMode mode = FrameMode::kFlat) {
  return LocalFrame(mode, to_radians(latitude_deg), to_radians(longitude_deg));
}

inline GridGeometry around_origin(double half_width_m, double spacing_m) {
  const int posts = 2 * static_cast<int>(half_width_m / spacing_m) + 1;
  return {-half_width_m, -half_width_m, spacing_m, posts, posts};
}

}  // namespace halocline::bathymetry::testing
