// SPDX-License-Identifier: BSD-3-Clause
// Maps as those who read them see them: GDAL, netCDF.
#include "simulation/coverage/coverage_files.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <nlohmann/json.hpp>
#include <ogr_spatialref.h>
#include <unistd.h>

#include "core/check.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::clients {
namespace {

constexpr double kLatitude = 43.6, kLongitude = 7.3;
constexpr std::size_t kSide = 20;

// A hill of delivery about the middle; one cell is land.
Coverage hill() {
  Coverage map;
  map.area = {
      .middle_north_m = 1000, .middle_east_m = 2000, .cell_m = 50, .side = kSide, .depths_m = {10, 30}};
  map.noise_level_db = 90;
  for (std::size_t depth = 0; depth < 2; ++depth) {
    std::vector<double> delivery, level_db, delay_s;
    for (std::size_t cell = 0; cell < kSide * kSide; ++cell) {
      const double north = map.area.north_m(cell / kSide) - 1000, east = map.area.east_m(cell % kSide) - 2000;
      const double r = std::hypot(north, east);
      delivery.push_back(std::exp(-r * r / 1e5));
      level_db.push_back(120 - r / 10 - static_cast<double>(depth));
      delay_s.push_back(r / 1500);
    }
    delivery[5] = level_db[5] = delay_s[5] = std::numeric_limits<double>::quiet_NaN();
    map.delivery.push_back(delivery);
    map.level_db.push_back(level_db);
    map.delay_s.push_back(delay_s);
  }
  return map;
}

class CoverageFiles : public ::testing::Test {
 protected:
  explicit CoverageFiles(bathymetry::FrameMode mode = bathymetry::FrameMode::kFlat)
      : file_{{CoverageQuantity::kDelivery, CoverageQuantity::kSnr},
              {mode, to_radians(kLatitude), to_radians(kLongitude)},
              "hill"} {}
  ~CoverageFiles() override { std::filesystem::remove(path_); }

  void write(const std::string& ending) {
    path_ = (std::filesystem::temp_directory_path() / ("halocline_coverage_" + std::to_string(::getpid())))
                .string() +
            ending;
    write_coverage(hill(), file_, path_);
  }
  static std::unique_ptr<GDALDataset> opened(const std::string& name) {
    GDALAllRegister();
    return std::unique_ptr<GDALDataset>(GDALDataset::Open(name.c_str(), GDAL_OF_READONLY));
  }

  CoverageFile file_;
  std::string path_;
};

// The scenario's origin is at (0, 0) of the system, 1000 m north of it are 1000 m of the meridian.
void expect_local_frame(const OGRSpatialReference& system,
                        bathymetry::FrameMode mode = bathymetry::FrameMode::kFlat) {
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> way(OGRCreateCoordinateTransformation(&system, &wgs84));
  ASSERT_TRUE(way);
  const bathymetry::LocalFrame frame(mode, to_radians(kLatitude), to_radians(kLongitude));
  for (const auto& [north, east] : {std::pair(0.0, 0.0), std::pair(1000.0, 0.0), std::pair(-500.0, 2000.0)}) {
    double x = east, y = north;
    ASSERT_TRUE(way->Transform(1, &x, &y));
    const auto place = frame.to_geodetic({north, east, 0});
    // The system is that of places on the ellipsoid; 2 km off a tangent plane is 0.3 m above it, which is 0.1
    // mm aside.
    const double off_deg = mode == bathymetry::FrameMode::kEnu ? 3e-9 : 1e-9;
    EXPECT_NEAR(y, to_degrees(place.latitude_rad), off_deg);
    EXPECT_NEAR(x, to_degrees(place.longitude_rad), off_deg);
  }
}

TEST_F(CoverageFiles, GeotiffHasTheScenariosFrameAndABandADepth) {
  write(".tif");
  const auto dataset = opened(path_);
  ASSERT_TRUE(dataset);
  ASSERT_NE(dataset->GetSpatialRef(), nullptr);
  expect_local_frame(*dataset->GetSpatialRef());
  std::array<double, 6> transform{};
  ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
  EXPECT_EQ(transform, (std::array<double, 6>{1500, 50, 0, 1500, 0, -50}));
  ASSERT_EQ(dataset->GetRasterCount(), 4);
  GDALRasterBand& band = *dataset->GetRasterBand(4);
  EXPECT_STREQ(band.GetDescription(), "snr at 30 m");
  EXPECT_STREQ(band.GetUnitType(), "dB");
  EXPECT_TRUE(std::isnan(band.GetNoDataValue()));
  std::vector<float> values(kSide * kSide);
  ASSERT_EQ(
      band.RasterIO(GF_Read, 0, 0, kSide, kSide, values.data(), kSide, kSide, GDT_Float32, 0, 0, nullptr),
      CE_None);
  const auto map = hill();
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      const double expected = map.level_db[1][row * kSide + column] - 90;
      const double got = values[(kSide - 1 - row) * kSide + column];
      EXPECT_TRUE(std::isnan(expected) ? std::isnan(got) : std::abs(got - expected) < 1e-5)
          << row << " " << column;
    }
  }
}

TEST_F(CoverageFiles, NetcdfFollowsTheConventions) {
  write(".nc");
  int file = 0, variable = 0;
  ASSERT_EQ(nc_open(path_.c_str(), NC_NOWRITE, &file), NC_NOERR);
  const auto attribute = [&](const char* name, const char* key) {
    int id = NC_GLOBAL;
    std::size_t size = 0;
    if (*name != '\0') {
      EXPECT_EQ(nc_inq_varid(file, name, &id), NC_NOERR) << name;
    }
    EXPECT_EQ(nc_inq_attlen(file, id, key, &size), NC_NOERR) << name << " " << key;
    std::string text(size, ' ');
    EXPECT_EQ(nc_get_att_text(file, id, key, text.data()), NC_NOERR);
    return text;
  };
  EXPECT_EQ(attribute("", "Conventions"), "CF-1.8");
  EXPECT_EQ(attribute("delivery", "grid_mapping"), "crs");
  EXPECT_EQ(attribute("delivery", "coordinates"), "lat lon");
  EXPECT_EQ(attribute("delivery", "units"), "1");
  EXPECT_EQ(attribute("snr", "units"), "dB");
  EXPECT_EQ(attribute("crs", "grid_mapping_name"), "transverse_mercator");
  EXPECT_EQ(attribute("x", "standard_name"), "projection_x_coordinate");
  EXPECT_EQ(attribute("y", "standard_name"), "projection_y_coordinate");
  EXPECT_EQ(attribute("depth", "standard_name"), "depth");
  EXPECT_EQ(attribute("depth", "positive"), "down");
  EXPECT_EQ(attribute("lat", "units"), "degrees_north");
  EXPECT_EQ(attribute("lon", "units"), "degrees_east");
  ASSERT_EQ(nc_inq_varid(file, "delivery", &variable), NC_NOERR);
  std::vector<double> values(2 * kSide * kSide);
  ASSERT_EQ(nc_get_var_double(file, variable, values.data()), NC_NOERR);
  EXPECT_EQ(values[kSide * kSide + 7], hill().delivery[1][7]);
  EXPECT_TRUE(std::isnan(values[5]));
  nc_close(file);
}

// GDAL reads the grid mapping by the same conventions.
TEST_F(CoverageFiles, NetcdfHasTheScenariosFrameForOthers) {
  write(".nc");
  const auto delivery = opened("NETCDF:\"" + path_ + "\":delivery");
  ASSERT_TRUE(delivery);
  ASSERT_EQ(delivery->GetRasterCount(), 2);
  ASSERT_NE(delivery->GetSpatialRef(), nullptr);
  expect_local_frame(*delivery->GetSpatialRef());
}

// exp(-r^2 / 1e5) = v at r = sqrt(-1e5 ln v): a circle about the middle.
TEST_F(CoverageFiles, GeojsonHasLinesOfEqualDelivery) {
  write(".geojson");
  std::ifstream in(path_);
  const auto json = nlohmann::json::parse(in);
  const bathymetry::LocalFrame& frame = file_.frame;
  int lines = 0;
  for (const auto& feature : json["features"]) {
    const auto& properties = feature["properties"];
    if (properties["quantity"] != "delivery" || properties["value"] != 0.75 || properties["depth_m"] != 30)
      continue;
    ++lines;
    for (const auto& point : feature["geometry"]["coordinates"]) {
      const Vec3 place =
          frame.to_ned({to_radians(point[1].get<double>()), to_radians(point[0].get<double>()), 0});
      // Linear between middles of cells: the curvature of the hill, 5e-5 / m^2 at most, bends by 0.06 within
      // 50 m.
      EXPECT_NEAR(std::hypot(place.x() - 1000, place.y() - 2000), std::sqrt(-1e5 * std::log(0.75)), 10);
    }
  }
  EXPECT_EQ(lines, 1);
}

TEST_F(CoverageFiles, PictureIsOne) {
  write(".png");
  std::ifstream in(path_, std::ios::binary);
  std::string magic(8, ' ');
  in.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
}

TEST_F(CoverageFiles, OtherEndingsAreRefused) { EXPECT_THROW(write(".jpg"), InvalidArgument); }

TEST_F(CoverageFiles, FilesThatCannotBeWrittenAreErrors) {
  for (const char* path : {"/nowhere/a.tif", "/nowhere/a.nc", "/nowhere/a.geojson"})
    EXPECT_THROW(write_coverage(hill(), file_, path), std::runtime_error) << path;
}

class CoverageFilesOnATangentPlane : public CoverageFiles {
 protected:
  CoverageFilesOnATangentPlane() : CoverageFiles(bathymetry::FrameMode::kEnu) {}
};

TEST_F(CoverageFilesOnATangentPlane, GeotiffHasTheScenariosFrame) {
  write(".tif");
  const auto dataset = opened(path_);
  ASSERT_TRUE(dataset);
  expect_local_frame(*dataset->GetSpatialRef(), bathymetry::FrameMode::kEnu);
}

}  // namespace
}  // namespace halocline::clients
