// SPDX-License-Identifier: BSD-3-Clause
// Rasters whose coordinates are metres of the scenario's own frame.
#include <array>

#include <gtest/gtest.h>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/terrain/height_grid.h"
#include "core/check.h"
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

TestRaster local_raster(const char* name, int columns, int rows, const std::array<double, 6>& geotransform) {
  return {
      .name = name, .columns = columns, .rows = rows, .geotransform = geotransform, .coordinate_system = ""};
}

TEST(LocalRaster, IsTakenPostByPost) {
  const TestRaster raster = local_raster("local", 4, 3, {-105, 10, 0, 215, 0, -10});
  const auto path = write_raster(raster, [](int c, int r) { return -(100.0 * r + c + 1); });
  const LoadedRaster loaded = load_local_raster({.path = path, .coordinate_system = "local"});
  EXPECT_EQ(loaded.grid.geometry(), (GridGeometry{190, -100, 10, 3, 4}));
  EXPECT_EQ(loaded.grid.post(0, 1), 202);  // the last row is the southernmost
  EXPECT_EQ(loaded.grid.post(2, 3), 4);
}

TEST(LocalRaster, CanBeResampledToo) {
  const TestRaster raster = local_raster("local_resampled", 40, 30, {-200, 10, 0, 150, 0, -10});
  const auto path = write_raster(raster, [](int c, int r) {
    const double east = -195 + 10 * c, north = 145 - 10 * r;
    return -(500 + north + 0.1 * east);
  });
  const LoadedRaster loaded =
      load_raster({.path = path, .coordinate_system = "local"}, frame_at(30, -28), around_origin(100, 2.5));
  EXPECT_NEAR(loaded.grid.post(0, 0), 500 - 100 - 10, tolerance(kFloatM));
  EXPECT_NEAR(loaded.grid.post(80, 0), 500 + 100 - 10, tolerance(kFloatM));
}

TEST(LocalRaster, NeedsSquarePixels) {
  const TestRaster raster = local_raster("oblong", 4, 3, {0, 10, 0, 0, 0, -20});
  const auto path = write_raster(raster, [](int, int) { return -1.0; });
  EXPECT_THROW(load_local_raster({.path = path, .coordinate_system = "local"}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry
