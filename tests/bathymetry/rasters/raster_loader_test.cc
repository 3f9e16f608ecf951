// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/raster_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <GeographicLib/UTMUPS.hpp>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/bathymetry/rasters/raster_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;
using testing::around_origin;
using testing::frame_at;
using testing::kFloatM;
using testing::TestRaster;
using testing::write_raster;
using testing::write_text;

// Depth that no turn or flip of the raster leaves as it is.
double slanted_depth(double latitude_deg, double longitude_deg) {
  return 1000 + 100 * (latitude_deg - 30) - 250 * (longitude_deg + 28);
}

// 41 x 31 pixels of 0.01 degrees, centres from 29.80 to 30.20 N and 28.15 to 27.85 W.
constexpr int kColumns = 31, kRows = 41;
constexpr double kStep = 0.01, kWest = -28.155, kNorth = 30.205;
TestRaster slanted_raster(const std::string& name) {
  return {.name = name,
          .columns = kColumns,
          .rows = kRows,
          .geotransform = std::array<double, 6>{kWest, kStep, 0, kNorth, 0, -kStep}};
}
double slanted_height(int column, int row) {
  return -slanted_depth(kNorth - (row + 0.5) * kStep, kWest + (column + 0.5) * kStep);
}

void expect_slanted(const HeightGrid& grid, const LocalFrame& frame, double error_m = kFloatM) {
  const GridGeometry& g = grid.geometry();
  for (int i = 0; i < g.posts_x; ++i) {
    for (int j = 0; j < g.posts_y; ++j) {
      const GeodeticPoint p = frame.to_geodetic({g.x_at(i), g.y_at(j), 0});
      const double expected = slanted_depth(to_degrees(p.latitude_rad), to_degrees(p.longitude_rad));
      ASSERT_NEAR(grid.post(i, j), expected, tolerance(error_m)) << i << " " << j;
    }
  }
}

TEST(RasterLoader, PutsEveryPostWhereItLies) {
  const LocalFrame frame = frame_at(30, -28);
  const LoadedRaster loaded = load_raster({.path = write_raster(slanted_raster("plain"), slanted_height)},
                                          frame, around_origin(5000, 50));
  expect_slanted(loaded.grid, frame, 3e-3);  // blocks may be off by 1e-4 pixels: 2.5 mm on this slope at most
  EXPECT_EQ(loaded.report.posts_without_depth, 0u);
}

TEST(RasterLoader, ReadsRowsThatRunFromSouthToNorth) {
  TestRaster raster = slanted_raster("south_up");
  raster.geotransform = {kWest, kStep, 0, kNorth - kRows * kStep, 0, kStep};
  const auto path = write_raster(raster, [](int c, int r) { return slanted_height(c, kRows - 1 - r); });
  const LocalFrame frame = frame_at(30, -28);
  expect_slanted(load_raster({.path = path}, frame, around_origin(3000, 100)).grid, frame, 3e-3);
}

TEST(RasterLoader, WithoutAGeotransformGoesByTheBoundsAndRowOrderGiven) {
  const LocalFrame frame = frame_at(30, -28);
  for (const RowOrder order : {RowOrder::kNorthFirst, RowOrder::kSouthFirst}) {
    const bool south_first = order == RowOrder::kSouthFirst;
    TestRaster raster = slanted_raster(south_first ? "bare_south" : "bare_north");
    raster.geotransform.reset();
    raster.coordinate_system.clear();
    RasterOptions options{.path = write_raster(raster, [&](int c, int r) {
                            return slanted_height(c, south_first ? kRows - 1 - r : r);
                          })};
    EXPECT_THROW(load_raster(options, frame, around_origin(3000, 100)), InvalidArgument);
    options.bounds = RasterBounds{kWest, kNorth - kRows * kStep, kWest + kColumns * kStep, kNorth, order};
    expect_slanted(load_raster(options, frame, around_origin(3000, 100)).grid, frame, 3e-3);
  }
}

TEST(RasterLoader, WithoutACoordinateSystemIsDegreesOnlyWhenTheOriginLiesInIt) {
  TestRaster raster = slanted_raster("no_system");
  raster.coordinate_system.clear();
  const auto path = write_raster(raster, slanted_height);
  const LoadedRaster loaded = load_raster({.path = path}, frame_at(30, -28), around_origin(3000, 100));
  EXPECT_EQ(loaded.report.coordinate_system, "assumed WGS 84 degrees");
  EXPECT_THROW(load_raster({.path = path}, frame_at(40, -28), around_origin(3000, 100)), InvalidArgument);
}

TEST(RasterLoader, ReadsEsriAsciiGrids) {
  std::string text =
      "ncols 3\nnrows 3\nxllcorner -28.03\nyllcorner 29.97\ncellsize 0.02\nNODATA_value -9999\n";
  text += "-100 -200 -9999\n-300 -400 -500\n-600 -700 -800\n";
  const auto path = write_text("grid.asc", text);
  const LoadedRaster loaded = load_raster({.path = path}, frame_at(30, -28), {0, 0, 10, 2, 2});
  EXPECT_EQ(loaded.grid.post(0, 0), 400);
  EXPECT_EQ(loaded.report.declared_no_data, 1u);
}

TEST(RasterLoader, DeclaredNoDataNeverBleeds) {
  TestRaster raster = slanted_raster("declared");
  raster.no_data = -32768;
  const auto path = write_raster(raster, [](int c, int r) { return c == 15 && r == 20 ? -32768 : -100.0; });
  const LoadedRaster loaded = load_raster({.path = path}, frame_at(30, -28), around_origin(2000, 20));
  EXPECT_EQ(loaded.report.deepest_m, 100);
  EXPECT_EQ(loaded.report.shallowest_m, 100);
  EXPECT_GT(loaded.report.posts_without_depth, 100u);
}

TEST(RasterLoader, UndeclaredNoDataIsRecognisedAndCounted) {
  for (const double mark : {-9999.0, -32768.0, 9999.0, -99999.0, -1e34}) {
    TestRaster raster = slanted_raster("undeclared" + std::to_string(static_cast<int>(std::max(mark, -1e6))));
    const auto path = write_raster(
        raster, [&](int c, int r) { return std::abs(c - 15) < 2 && std::abs(r - 20) < 2 ? mark : -100.0; });
    const LoadedRaster loaded = load_raster({.path = path}, frame_at(30, -28), around_origin(4000, 50));
    EXPECT_EQ(loaded.report.deepest_m, 100) << mark;
    EXPECT_EQ(loaded.report.shallowest_m, 100) << mark;
    EXPECT_EQ(loaded.report.undeclared_no_data, 9u) << mark;
  }
}

TEST(RasterLoader, ATrenchIsNoNoData) {
  // Down to 10 900 m, through -9999 exactly.
  const auto depth = [](int r) { return 9999 + 100.0 * (r - 20); };
  TestRaster raster = slanted_raster("trench");
  const auto path = write_raster(raster, [&](int, int r) { return -std::min(depth(r), 10'900.0); });
  const LoadedRaster loaded = load_raster({.path = path}, frame_at(30, -28), around_origin(8000, 100));
  EXPECT_EQ(loaded.report.undeclared_no_data, 0u);
  EXPECT_EQ(loaded.report.posts_without_depth, 0u);
  EXPECT_GT(loaded.report.deepest_m, 10'500);
}

TEST(RasterLoader, AValueCanBeNamedNoDataAndSuspicionSwitchedOff) {
  TestRaster raster = slanted_raster("named");
  const auto path = write_raster(raster, [](int c, int r) { return c == 15 && r == 20 ? 0.0 : -9999.0; });
  const LocalFrame frame = frame_at(30, -28);
  const LoadedRaster named =
      load_raster({.path = path, .no_data = 0.0, .trust_every_value = true}, frame, around_origin(3000, 50));
  EXPECT_EQ(named.report.declared_no_data, 1u);
  EXPECT_EQ(named.report.shallowest_m, 9999);
}

TEST(RasterLoader, DepthPositiveDownIsAnExplicitChoice) {
  const auto path = write_raster(slanted_raster("down"), [](int, int) { return 250.0; });
  const LocalFrame frame = frame_at(30, -28);
  EXPECT_EQ(
      load_raster({.path = path, .positive_down = true}, frame, around_origin(500, 50)).report.deepest_m,
      250);
  const RasterReport up = load_raster({.path = path}, frame, around_origin(500, 50)).report;
  EXPECT_EQ(up.deepest_m, -250);
  EXPECT_EQ(up.posts_above_datum, 21u * 21u);  // the hint that the sign is wrong
}

TEST(RasterLoader, AppliesUnitScaleAndOffset) {
  TestRaster raster = slanted_raster("scaled");
  raster.type = GDT_Int16;
  raster.unit = "ft";
  raster.scale = 0.1;
  raster.offset = -50;
  const auto path = write_raster(raster, [](int, int) { return -1000.0; });  // -150 ft
  EXPECT_NEAR(load_raster({.path = path}, frame_at(30, -28), around_origin(500, 50)).report.deepest_m, 45.72,
              tolerance(1e-5));
  raster.name = "furlong";
  raster.unit = "furlong";
  const auto unknown = write_raster(raster, [](int, int) { return -1000.0; });
  EXPECT_THROW(load_raster({.path = unknown}, frame_at(30, -28), around_origin(500, 50)), InvalidArgument);
}

TEST(RasterLoader, CarriesTheVerticalDatumAndItsOffset) {
  const auto path = write_raster(slanted_raster("datum"), [](int, int) { return -100.0; });
  const LocalFrame frame = frame_at(30, -28);
  const LoadedRaster loaded = load_raster({.path = path, .vertical_datum = "LAT", .datum_offset_m = -1.8},
                                          frame, around_origin(500, 50));
  EXPECT_EQ(loaded.report.vertical_datum, "LAT");
  EXPECT_FLOAT_EQ(loaded.grid.post(3, 3), 98.2f);
  EXPECT_EQ(load_raster({.path = path}, frame, around_origin(500, 50)).report.vertical_datum, "unstated");
  TestRaster compound = slanted_raster("compound");
  compound.coordinate_system = "EPSG:4326+3855";  // EGM2008 height
  const auto with_datum = write_raster(compound, [](int, int) { return -100.0; });
  EXPECT_NE(
      load_raster({.path = with_datum}, frame, around_origin(500, 50)).report.vertical_datum.find("EGM2008"),
      std::string::npos);
}

TEST(RasterLoader, NodeRegistrationPutsTheOuterPostsOnTheBounds) {
  TestRaster raster = slanted_raster("node");
  // 0.1 degrees a node: bounds on the outer nodes, as a node-registered file that declares its extent has
  // them.
  raster.columns = raster.rows = 3;
  raster.geotransform = {-28.1, 0.2 / 3, 0, 30.1, 0, -0.2 / 3};
  const auto path =
      write_raster(raster, [](int c, int r) { return -slanted_depth(30.1 - 0.1 * r, -28.1 + 0.1 * c); });
  const LocalFrame frame = frame_at(30, -28);
  const LoadedRaster node =
      load_raster({.path = path, .registration = Registration::kNode}, frame, around_origin(8000, 100));
  expect_slanted(node.grid, frame, 3e-3);
  EXPECT_EQ(node.report.posts_without_depth, 0u);
}

// A whole earth of 5 degrees: 72 columns whose centres are 0, 5, ... 355 east, rows whose centres run from
// pole to pole, so that pixel edges lie at +-92.5 degrees.
TestRaster whole_earth(const std::string& name, double step = 5) {
  return {.name = name,
          .columns = 72,
          .rows = 37,
          .geotransform = std::array<double, 6>{-step / 2, step, 0, 92.5, 0, -5}};
}

TEST(RasterLoader, FindsWesternLongitudesInARasterFrom0To360) {
  const auto path = write_raster(whole_earth("earth"), [](int c, int) { return -100.0 * c; });
  // 30 W is 330 E: column 66.
  const LoadedRaster loaded = load_raster({.path = path}, frame_at(30, -30), {0, 0, 10, 2, 2});
  EXPECT_NEAR(loaded.grid.post(0, 0), 6600, tolerance(1e-3));
  EXPECT_GT(loaded.grid.post(0, 1), 6600);  // towards the east
  EXPECT_LT(loaded.report.window_columns, 6);
}

TEST(RasterLoader, CrossesTheSeamOfAWholeEarth) {
  const auto path = write_raster(whole_earth("seam"),
                                 [](int c, int) { return c == 71 ? -1000.0 : (c == 0 ? -2000.0 : 0); });
  // Half way from 355 E to 0 E.
  EXPECT_NEAR(load_raster({.path = path}, frame_at(0, -2.5), {0, 0, 10, 2, 2}).grid.post(0, 0), 1500,
              tolerance(1e-2));
  EXPECT_NEAR(load_raster({.path = path}, frame_at(0, 357.5), {0, 0, 10, 2, 2}).grid.post(0, 0), 1500,
              tolerance(1e-2));
  const LoadedRaster wide = load_raster({.path = path}, frame_at(0, 0), around_origin(300'000, 10'000));
  EXPECT_NEAR(wide.grid.post(30, 30), 2000, tolerance(1e-2));
  EXPECT_EQ(wide.report.posts_without_depth, 0u);
}

TEST(RasterLoader, ReadsNearThePoleOfARasterWhoseEdgesPassIt) {
  const auto path = write_raster(whole_earth("pole"), [](int, int r) { return -10.0 * r - 1000; });
  const LoadedRaster loaded = load_raster({.path = path}, frame_at(89, 10), {0, 0, 10, 2, 2});
  EXPECT_NEAR(loaded.grid.post(0, 0), 1002, tolerance(1e-2));
}

TEST(RasterLoader, ClosesTheTurnOfADriftingLongitudeAxis) {
  // The rounded step makes the last column lie 0.36 degrees too far east, as ETOPO5's lies 0.0033.
  const auto path = write_raster(whole_earth("drift", 5.005), [](int c, int) { return -100.0 * c; });
  EXPECT_NEAR(load_raster({.path = path}, frame_at(30, -10), {0, 0, 10, 2, 2}).grid.post(0, 0), 7000,
              tolerance(0.05));
}

TEST(RasterLoader, ReprojectsFromUtm) {
  TestRaster raster = slanted_raster("utm");
  raster.coordinate_system = "EPSG:32626";  // zone 26 north, central meridian 27 W
  raster.geotransform = {380'000, 500, 0, 3'340'000, 0, -500};
  raster.columns = raster.rows = 81;
  // The origin in UTM by another code than the loader's PROJ.
  int zone = 0;
  bool north_half = false;
  double easting = 0, northing = 0;
  GeographicLib::UTMUPS::Forward(30, -28, zone, north_half, easting, northing);
  const auto path = write_raster(raster, [&](int c, int r) {
    return -(1000 + 0.01 * (3'340'000 - 500 * (r + 0.5) - northing) +
             0.02 * (380'000 + 500 * (c + 0.5) - easting));
  });
  const LoadedRaster loaded = load_raster({.path = path}, frame_at(30, -28), around_origin(2000, 100));
  EXPECT_NEAR(loaded.grid.post(20, 20), 1000, tolerance(0.005));
  // A local metre is a UTM metre to 4e-4; UTM north is turned by half a degree here.
  EXPECT_NEAR(loaded.grid.post(30, 20) - loaded.grid.post(20, 20), 10, tolerance(0.3));
  EXPECT_NEAR(loaded.grid.post(20, 30) - loaded.grid.post(20, 20), 20, tolerance(0.3));
}

TEST(RasterLoader, InEnuModeTheBottomFallsAwayWithTheEarth) {
  const auto path = write_raster(slanted_raster("curved"), [](int, int) { return -1000.0; });
  const LocalFrame frame = frame_at(30, -28, FrameMode::kEnu);
  const LoadedRaster loaded = load_raster({.path = path}, frame, {-10'000, 0, 1000, 21, 2});
  EXPECT_NEAR(loaded.grid.post(10, 0), 1000, tolerance(1e-3));
  EXPECT_NEAR(loaded.grid.post(20, 0) - 1000, 7.85, tolerance(0.03));
  for (const int i : {0, 7, 20}) {
    const GeodeticPoint p = frame.to_geodetic({loaded.grid.geometry().x_at(i), 0, loaded.grid.post(i, 0)});
    EXPECT_NEAR(p.depth_m, 1000, tolerance(1e-3)) << i;
  }
}

TEST(RasterLoader, ReadsOnlyTheWindowOfTheScenario) {
  TestRaster raster = slanted_raster("large");
  raster.columns = 3000;
  raster.rows = 2000;
  raster.geotransform = {-38, 0.01, 0, 40, 0, -0.01};
  const auto path = write_raster(raster, [](int, int) { return -100.0; });
  const RasterReport report = load_raster({.path = path}, frame_at(30, -28), around_origin(3000, 100)).report;
  EXPECT_LT(report.window_columns, 14);
  EXPECT_LT(report.window_rows, 14);
  EXPECT_EQ(report.raster_columns, 3000);
}

TEST(RasterLoader, BeyondTheRasterThereIsNoDataAndFarFromItAnError) {
  const auto path = write_raster(slanted_raster("edge"), slanted_height);
  const LoadedRaster half = load_raster({.path = path}, frame_at(30, -27.85), around_origin(3000, 100));
  EXPECT_FALSE(std::isnan(half.grid.post(30, 29)));
  EXPECT_TRUE(std::isnan(half.grid.post(30, 40)));
  EXPECT_THROW(load_raster({.path = path}, frame_at(50, -28), around_origin(3000, 100)), InvalidArgument);
}

TEST(RasterLoader, ReportsWhyAFileCannotBeRead) {
  try {
    load_raster({.path = "/vsimem/absent.tif"}, frame_at(30, -28), around_origin(100, 10));
    FAIL() << "an absent file was read";
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("absent.tif"), std::string::npos);
  }
  const auto text = write_text("no_raster.asc", "this is no raster");
  EXPECT_THROW(load_raster({.path = text}, frame_at(30, -28), around_origin(100, 10)), InvalidArgument);
  const auto path = write_raster(slanted_raster("one_band"), slanted_height);
  EXPECT_THROW(load_raster({.path = path, .band = 2}, frame_at(30, -28), around_origin(100, 10)),
               InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry
