// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of bathymetry/, compiled and run (tests/docs/check_examples).
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/local_frame.h"
#include "bathymetry/terrain/terrain.h"
#include "core/units.h"
#include "tests/support/working_folder.h"

namespace halocline::bathymetry {
namespace {

TEST(HeaderExamples, RasterLoader) {
  const std::filesystem::path ferret_datasets = "/usr/share/ferret-vis/data";
  if (!std::filesystem::exists(ferret_datasets)) GTEST_SKIP() << "ferret-datasets is not installed";
  const testing::WorkingFolder folder(ferret_datasets);
  const LocalFrame frame(FrameMode::kFlat, to_radians(29.9167), to_radians(-28.4167));
  const LoadedRaster loaded = load_raster({.path = "etopo5.cdf"}, frame, {-8000, -8000, 20, 801, 801});
  const Terrain terrain(loaded.grid);
  EXPECT_EQ(loaded.report.posts_without_depth, 0u);
  EXPECT_NEAR(terrain.depth_at(0, 0).z_m, 146, 1);  // Great Meteor's summit
}

TEST(HeaderExamples, TerrainRecipe) {
  TerrainRecipe recipe;
  recipe.flat.depth_m = 70;
  const PreparedTerrain prepared = prepare_terrain(recipe, {29.9167, -28.4167});
  EXPECT_EQ(prepared.terrain->depth_at(0, 0).z_m, 70);
}

TEST(HeaderExamples, Terrain) {
  const GridGeometry geometry{-100, -100, 10, 21, 21};
  const Terrain terrain(make_grid(geometry, FlatShape{.depth_m = 100}));
  const RayHit hit =
      terrain.closest_hit({.origin_ned_m = {0, 0, 20}, .direction = {0, 0, 1}, .max_range_m = 500});
  EXPECT_EQ(hit.status, RayStatus::kHit);
  EXPECT_NEAR(hit.range_m, 80, 1e-9);
}

}  // namespace
}  // namespace halocline::bathymetry
