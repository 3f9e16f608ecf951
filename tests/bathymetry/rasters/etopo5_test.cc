// SPDX-License-Identifier: BSD-3-Clause
// The real relief that ships with Debian's ferret-datasets: NOAA ETOPO5, netCDF, 5 arc-minutes,
// node-registered.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/terrain/local_frame.h"
#include "core/check.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;

constexpr char kPath[] = "/usr/share/ferret-vis/data/etopo5.cdf";
constexpr double kStepDeg = 1.0 / 12;

class Etopo5 : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kPath)) GTEST_SKIP() << "ferret-datasets is not installed";
  }
};

double depth_at(double latitude_deg, double longitude_deg) {
  const LocalFrame frame(FrameMode::kFlat, to_radians(latitude_deg), to_radians(longitude_deg));
  return load_raster({.path = kPath}, frame, {0, 0, 1, 2, 2}).grid.post(0, 0);
}

// Values read with ncdump at the file's own indices: row (latitude + 90) * 12 from the south, column
// longitude * 12 from Greenwich. The nodes around Great Meteor's summit differ from each other by hundreds of
// metres, so a shift by half a node, a flip, or the drift of the longitude axis (2 % of a node here) would
// show.
TEST_F(Etopo5, HasGreatMeteorSeamountWhereItIs) {
  const double latitude = 29 + 11 * kStepDeg, longitude = -28 - 5 * kStepDeg;
  EXPECT_NEAR(depth_at(latitude, longitude), 146, tolerance(0.05));
  EXPECT_NEAR(depth_at(latitude, longitude + kStepDeg), 445, tolerance(0.05));
  EXPECT_NEAR(depth_at(latitude, longitude - kStepDeg), 400, tolerance(0.05));
  EXPECT_NEAR(depth_at(latitude + 2 * kStepDeg, longitude), 214, tolerance(0.05));
  EXPECT_NEAR(depth_at(latitude - 3 * kStepDeg, longitude), 1296, tolerance(0.05));
}

TEST_F(Etopo5, IsReadByAWindow) {
  const LocalFrame frame(FrameMode::kFlat, to_radians(29.9167), to_radians(-28.4167));
  const LoadedRaster loaded =
      load_raster({.path = kPath, .variable = "ROSE"}, frame, {-8000, -8000, 100, 161, 161});
  EXPECT_LE(loaded.report.window_columns, 8);
  EXPECT_EQ(loaded.report.posts_without_depth, 0u);
  EXPECT_EQ(loaded.report.posts_above_datum, 0u);
  EXPECT_GT(loaded.report.shallowest_m, 140);
  EXPECT_LT(loaded.report.deepest_m, 1500);
}

TEST_F(Etopo5, CrossesGreenwichWithoutASeam) {
  const LocalFrame frame(FrameMode::kFlat, to_radians(0.0), to_radians(0.0));
  const LoadedRaster loaded = load_raster({.path = kPath}, frame, {-20'000, -20'000, 500, 81, 81});
  EXPECT_EQ(loaded.report.posts_without_depth, 0u);
  EXPECT_GT(loaded.report.shallowest_m, 4000);  // the Gulf of Guinea
}

TEST_F(Etopo5, ForAnUnknownVariableNamesThoseItHas) {
  const LocalFrame frame(FrameMode::kFlat, 0.5, -0.5);
  EXPECT_THROW(load_raster({.path = kPath, .variable = "elevation"}, frame, {0, 0, 1, 2, 2}),
               InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry
