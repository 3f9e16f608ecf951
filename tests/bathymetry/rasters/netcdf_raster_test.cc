// SPDX-License-Identifier: BSD-3-Clause
// Rasters of netCDF: axes as they are, declared signs, files that are cut short.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/rasters/raster_options.h"
#include "core/check.h"
#include "tests/bathymetry/rasters/raster_fixtures.h"
#include "tests/ocean/sea_file.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;
using ocean::testing::good;
using ocean::testing::Texts;
using ::testing::AllOf;
using testing::around_origin;
using ::testing::ElementsAre;
using testing::frame_at;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Heights, linear in latitude and longitude unless told otherwise.
struct GridFile {
  std::vector<double> latitudes{43.0, 43.1, 43.2, 43.3, 43.4}, longitudes{7.1, 7.2, 7.3, 7.4, 7.5};
  std::string rows = "lat", columns = "lon";
  Texts of_rows{{"units", "degrees_north"}}, of_columns{{"units", "degrees_east"}};
  Texts of_heights{{"units", "m"}};
  bool rows_first = true;
  double (*height)(double, double) = [](double latitude, double longitude) {
    return -(120 + 100 * (latitude - 43.2) - 50 * (longitude - 7.3));
  };
  bool has_positions = false;  // in two dimensions

  std::string write(const std::string& name) const {
    const std::string path = ::testing::TempDir() + "grid-" + std::to_string(getpid()) + "-" + name + ".nc";
    int file = 0, row = 0, column = 0, row_axis = 0, column_axis = 0, heights = 0, lat = 0, lon = 0;
    const auto put = [&](int variable, const Texts& attributes) {
      for (const auto& [key, text] : attributes)
        good(nc_put_att_text(file, variable, key.c_str(), text.size(), text.c_str()));
    };
    good(nc_create(path.c_str(), NC_CLOBBER, &file));
    good(nc_def_dim(file, rows.c_str(), latitudes.size(), &row));
    good(nc_def_dim(file, columns.c_str(), longitudes.size(), &column));
    good(nc_def_var(file, rows.c_str(), NC_DOUBLE, 1, &row, &row_axis));
    good(nc_def_var(file, columns.c_str(), NC_DOUBLE, 1, &column, &column_axis));
    put(row_axis, of_rows);
    put(column_axis, of_columns);
    const int plane[2]{rows_first ? row : column, rows_first ? column : row};
    good(nc_def_var(file, "z", NC_FLOAT, 2, plane, &heights));
    put(heights, of_heights);
    if (has_positions) {
      good(nc_def_var(file, "nav_lat", NC_DOUBLE, 2, plane, &lat));
      good(nc_def_var(file, "nav_lon", NC_DOUBLE, 2, plane, &lon));
      put(lat, {{"units", "degrees_north"}});
      put(lon, {{"units", "degrees_east"}});
      put(heights, {{"coordinates", "nav_lon nav_lat"}});
    }
    good(nc_enddef(file));
    good(nc_put_var_double(file, row_axis, latitudes.data()));
    good(nc_put_var_double(file, column_axis, longitudes.data()));
    std::vector<float> values;
    const auto &outer = rows_first ? latitudes : longitudes, &inner = rows_first ? longitudes : latitudes;
    for (const double a : outer) {
      for (const double b : inner)
        values.push_back(static_cast<float>(rows_first ? height(a, b) : height(b, a)));
    }
    good(nc_put_var_float(file, heights, values.data()));
    if (has_positions) {
      const std::vector<double> north(values.size(), 43.2), east(values.size(), 7.3);
      good(nc_put_var_double(file, lat, north.data()));
      good(nc_put_var_double(file, lon, east.data()));
    }
    good(nc_close(file));
    return path;
  }
};

LoadedRaster loaded(const std::string& path, RasterOptions options = {}) {
  options.path = path;
  return load_raster(options, frame_at(43.2, 7.3), around_origin(2000, 100));
}

double depth_at_origin(const GridFile& file, const std::string& name) {
  return loaded(file.write(name)).grid.post(20, 20);
}

std::string refusal(const std::string& path, const RasterOptions& options = {}) {
  try {
    loaded(path, options);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "loaded";
}

// Depths are linear in latitude and longitude: so is their interpolation, whatever the axes.
TEST(NetcdfRaster, UnevenAxesAreInterpolatedInTheirOwnCoordinates) {
  const std::vector<double> uneven_rows{43.0, 43.1, 43.17, 43.25, 43.7},
      uneven_columns{7.0, 7.2, 7.25, 7.36, 7.9};
  std::vector<double> falling(uneven_rows.rbegin(), uneven_rows.rend());
  GridFile rows, columns, both, fall, crossed;
  rows.latitudes = both.latitudes = crossed.latitudes = uneven_rows;
  columns.longitudes = both.longitudes = uneven_columns;
  fall.latitudes = falling;
  crossed.rows_first = false;
  for (const GridFile& file : {GridFile{}, rows, columns, both, fall, crossed}) {
    const LoadedRaster raster = loaded(file.write("uneven"));
    EXPECT_NEAR(raster.grid.post(20, 20), 120, tolerance(1e-3));
    EXPECT_THAT(raster.report.warnings, IsEmpty());
    EXPECT_EQ(raster.report.posts_without_depth, 0u);
    // 2000 m north are 0.0180 degrees, 2000 m east 0.0246.
    EXPECT_NEAR(raster.grid.post(40, 20), 121.80, tolerance(0.01));
    EXPECT_NEAR(raster.grid.post(20, 40), 118.77, tolerance(0.01));
  }
}

// 900 rows even in Mercator's projection from 30 to 50 N: taken as even in latitude, 43.2 N lies 75 km off.
TEST(NetcdfRaster, AMercatorGridLiesWhereItsLatitudesSay) {
  GridFile file;
  file.latitudes.clear();
  const auto mercator = [](double degrees) { return std::asinh(std::tan(to_radians(degrees))); };
  for (int i = 0; i < 900; ++i) {
    const double y = mercator(30) + (mercator(50) - mercator(30)) * i / 899;
    file.latitudes.push_back(to_degrees(std::atan(std::sinh(y))));
  }
  EXPECT_NEAR(depth_at_origin(file, "mercator"), 120, tolerance(1e-3));
}

TEST(NetcdfRaster, AnUnevenGridThatGoesRoundTheEarthHasNoSeam) {
  GridFile file;
  file.latitudes = {-40, 10, 43, 44, 80};
  file.longitudes = {10, 100, 190, 280};
  file.height = [](double, double longitude) { return longitude < 300 && longitude > 200 ? -400.0 : -100.0; };
  // From 280 (400 m) to 370 (100 m), at 367.3.
  EXPECT_NEAR(depth_at_origin(file, "round"), 400 - 300 * 87.3 / 90, tolerance(1e-2));
}

TEST(NetcdfRaster, PositionsInTwoDimensionsAreNamed) {
  GridFile file;
  file.has_positions = true;
  file.rows = "y";
  file.columns = "x";
  file.of_rows = file.of_columns = {};
  EXPECT_THAT(refusal(file.write("curvilinear")),
              AllOf(HasSubstr("z: its places are in two dimensions (nav_lat, nav_lon)"),
                    HasSubstr("regrid it first")));
}

TEST(NetcdfRaster, UnevenAxesOfAProjectionAreRefused) {
  GridFile file;
  file.rows = "y";
  file.columns = "x";
  file.latitudes = {0, 1000, 3000, 7000, 9000};
  file.of_rows = file.of_columns = {{"units", "m"}};
  EXPECT_THAT(refusal(file.write("projected")), HasSubstr("y: is unevenly spaced"));
}

TEST(NetcdfRaster, ADeclaredSignCounts) {
  for (const Texts& declared : {Texts{{"units", "m"}, {"positive", "down"}},
                                Texts{{"units", "m"}, {"standard_name", "sea_floor_depth_below_geoid"}}}) {
    for (const bool is_even : {true, false}) {
      GridFile file;
      if (!is_even) file.latitudes[3] = 43.25;
      file.of_heights = declared;
      file.height = [](double, double) { return 120.0; };
      EXPECT_EQ(depth_at_origin(file, "down"), 120);
      file.of_heights.emplace_back("positive", "up");
      file.of_heights.emplace_back("standard_name", "sea_floor_depth");
      EXPECT_THAT(refusal(file.write("contradiction")), HasSubstr("they contradict each other"));
    }
  }
  GridFile heights;
  heights.of_heights = {{"units", "m"}, {"standard_name", "height_above_mean_sea_level"}};
  EXPECT_NEAR(depth_at_origin(heights, "up"), 120, tolerance(1e-3));
  EXPECT_THAT(refusal(heights.write("up"), {.positive_down = true}), HasSubstr("the file declares heights"));
}

TEST(NetcdfRaster, DepthsTakenForHeightsAreHintedAt) {
  GridFile file;
  file.height = [](double, double) { return 120.0; };
  EXPECT_THAT(loaded(file.write("undeclared")).report.warnings,
              ElementsAre(HasSubstr("positive_down = true")));
}

// A plane of 120 m with a patch of 999: the usual mark, and a cliff of 880 m if it is taken as it stands.
TEST(NetcdfRaster, AnUndeclaredMarkIsNoDepthAndSaid) {
  for (const double mark : {999.0, -999.0, 9999.0, -9999.0}) {
    GridFile file;
    file.latitudes.clear();
    file.longitudes.clear();
    for (int i = 0; i <= 40; ++i) {
      file.latitudes.push_back(43.18 + 0.001 * i);
      file.longitudes.push_back(7.28 + 0.001 * i);
    }
    static double value;
    value = mark;
    file.height = [](double latitude, double longitude) {
      return std::abs(latitude - 43.2) < 0.0025 && std::abs(longitude - 7.3) < 0.0025
                 ? value
                 : -(120 + 100 * (latitude - 43.2));
    };
    const LoadedRaster raster = loaded(file.write("mark"));
    EXPECT_LT(raster.report.deepest_m, 125) << mark;
    EXPECT_GT(raster.report.shallowest_m, 115) << mark;
    EXPECT_GE(raster.report.undeclared_no_data, 16u);
    EXPECT_THAT(raster.report.warnings, ElementsAre(HasSubstr("trust_every_value = true keeps them")));
    EXPECT_THAT(loaded(file.write("mark"), {.trust_every_value = true}).report.warnings, IsEmpty());
  }
}

TEST(NetcdfRaster, ASlopeThrough999IsNoMark) {
  GridFile file;
  file.height = [](double latitude, double) { return std::round(-999 + 1000 * (latitude - 43.2)); };
  file.latitudes = {43.198, 43.199, 43.2, 43.201, 43.202};
  file.longitudes = {7.298, 7.299, 7.3, 7.301, 7.302};
  const LoadedRaster raster =
      load_raster({.path = file.write("slope")}, frame_at(43.2, 7.3), around_origin(100, 10));
  EXPECT_EQ(raster.report.undeclared_no_data, 0u);
  file.height = [](double, double) { return -999.0; };
  EXPECT_EQ(
      load_raster({.path = file.write("flat")}, frame_at(43.2, 7.3), around_origin(100, 10)).report.deepest_m,
      999);
}

TEST(NetcdfRaster, AFileThatLostItsEndIsRefused) {
  const std::string path = GridFile{}.write("cut");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 40);
  EXPECT_THAT(refusal(path),
              AllOf(HasSubstr("is cut short: its variable z ends at byte"), HasSubstr("fetch it again")));
}

}  // namespace
}  // namespace halocline::bathymetry
