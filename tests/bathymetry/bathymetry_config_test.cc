// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/bathymetry_config.h"

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/local_frame.h"
#include "bathymetry/terrain/terrain.h"
#include "core/check.h"
#include "tests/bathymetry/rasters/raster_fixtures.h"

namespace halocline::bathymetry {
namespace {

// Beside the files bottom.tif and fine.tif, which hold nothing.
TerrainRecipe parse(const std::string& text) {
  for (const char* name : {"bottom.tif", "fine.tif"}) std::ofstream(::testing::TempDir() + name);
  TerrainRecipe recipe;
  bus::ConfigFile file = bus::ConfigFile::parse(text, ::testing::TempDir() + "test.toml");
  file.read([&](bus::ConfigVisitor& v) { visit(v, recipe); });
  file.check(true);
  return recipe;
}

std::string errors_of(const std::string& text) {
  try {
    parse(text);
  } catch (const bus::ConfigErrors& errors) {
    std::string all;
    for (const std::string& line : errors.lines()) all += line + "\n";
    return all;
  }
  return "";
}

TEST(BathymetryConfig, WithoutASectionIsAFlatBottom) {
  const TerrainRecipe recipe = parse("");
  EXPECT_EQ(recipe.kind, TerrainKind::kFlat);
  EXPECT_EQ(prepare_terrain(recipe, {}).terrain->depth_at(0, 0).z_m, 100);
}

TEST(BathymetryConfig, FillsTheRecipe) {
  const TerrainRecipe recipe = parse(R"(
    [terrain]
    kind = "raster"
    frame = "enu"
    size_north_m = 8000
    size_east_m = 6000
    spacing_m = 25
    [terrain.ridge]
    azimuth_deg = 90
    [terrain.raster]
    path = "bottom.tif"
    positive_down = true
    registration = "node"
    no_data = [-1]
    bounds = [-29, 29, -28, 30]
    row_order = "south_first"
    datum_offset_m = -1.5
    [terrain.relief]
    rms_m = 3
    seed = 5
    [[terrain.nested]]
    size_north_m = 500
    size_east_m = 500
    spacing_m = 5
    blend_width_m = 50
    holes = "fill_from_around"
    [terrain.nested.raster]
    path = "fine.tif"
  )");
  EXPECT_EQ(recipe.kind, TerrainKind::kRaster);
  EXPECT_EQ(recipe.frame, FrameMode::kEnu);
  EXPECT_EQ(recipe.domain.geometry(), (GridGeometry{-4000, -3000, 25, 321, 241}));
  EXPECT_DOUBLE_EQ(recipe.ridge.azimuth_rad, std::numbers::pi / 2);
  EXPECT_TRUE(recipe.raster.positive_down);
  EXPECT_EQ(recipe.raster.registration, Registration::kNode);
  EXPECT_EQ(recipe.raster.no_data, -1.0);
  ASSERT_TRUE(recipe.raster.bounds.has_value());
  EXPECT_EQ(recipe.raster.bounds->east, -28);
  EXPECT_EQ(recipe.raster.bounds->row_order, RowOrder::kSouthFirst);
  EXPECT_EQ(recipe.relief.seed, 5u);
  ASSERT_EQ(recipe.nested.size(), 1u);
  EXPECT_EQ(recipe.nested[0].holes, Holes::kFillFromAround);
  EXPECT_EQ(recipe.nested[0].raster.path.given(), "fine.tif");
}

TEST(BathymetryConfig, ReportsTheFaultOfEachKey) {
  const std::string errors = errors_of(R"(
    [terrain]
    kind = "raster"
    size_north_m = 1001
    spacing_m = 10
    depth = 3
    [terrain.relief]
    hurst = 2
  )");
  EXPECT_NE(errors.find("spacing_m"), std::string::npos) << errors;
  EXPECT_NE(errors.find("depth"), std::string::npos) << errors;
  EXPECT_NE(errors.find("hurst"), std::string::npos) << errors;
  EXPECT_NE(errors.find("path"), std::string::npos) << errors;
}

TEST(BathymetryConfig, ARasterThatIsNotThereIsAnErrorThatNamesIt) {
  const std::string gone = "there is no such file";
  EXPECT_NE(errors_of("[terrain]\nkind = \"raster\"\n[terrain.raster]\npath = \"gone.tif\"").find(gone),
            std::string::npos);
  EXPECT_NE(errors_of("[[terrain.nested]]\n[terrain.nested.raster]\npath = \"gone.tif\"").find(gone),
            std::string::npos);
  for (const char* name : {"NETCDF:gone.nc:z", "/vsicurl/http://127.0.0.1/a.tif", "WMS:http://127.0.0.1/"}) {
    EXPECT_NE(
        errors_of("[terrain]\nkind = \"raster\"\n[terrain.raster]\npath = \"" + std::string(name) + "\"")
            .find(gone),
        std::string::npos)
        << name;
  }
}

TEST(BathymetryConfig, BoundsNeedFourNumbersAndARowOrder) {
  const std::string head = "[terrain.raster]\npath = \"a.tif\"\n";
  EXPECT_NE(errors_of(head + "bounds = [1, 2, 3]\nrow_order = \"north_first\"").find("bounds"),
            std::string::npos);
  EXPECT_NE(errors_of(head + "bounds = [1, 2, 3, 4]").find("row_order"), std::string::npos);
  EXPECT_EQ(errors_of(head + "bounds = [1, 2, 3, 4]\nrow_order = \"north_first\""), "");
}

TEST(BathymetryConfig, WrittenConfigurationReadsBackTheSame) {
  TerrainRecipe recipe;
  recipe.kind = TerrainKind::kSeamount;
  recipe.raster.path = "x.tif";
  recipe.raster.bounds = RasterBounds{1, 2, 3, 4, RowOrder::kSouthFirst};
  recipe.raster.no_data = -5;
  const auto write = [](TerrainRecipe& r) {
    return bus::to_toml([&](bus::ConfigVisitor& v) { visit(v, r); }, false);
  };
  const std::string text = write(recipe);
  TerrainRecipe back = parse(text);
  EXPECT_EQ(write(back), text);
}

TEST(TerrainRecipe, EveryGeneratedKindMakesItsTerrain) {
  TerrainRecipe recipe;
  recipe.kind = TerrainKind::kSeamount;
  recipe.seamount = {.depth_m = 500, .height_m = 300, .radius_m = 400};
  EXPECT_EQ(prepare_terrain(recipe, {}).terrain->depth_at(0, 0).z_m, 200);
  recipe.kind = TerrainKind::kRidge;
  recipe.ridge = {.depth_m = 90, .height_m = 50, .half_width_m = 100};
  EXPECT_EQ(prepare_terrain(recipe, {}).terrain->depth_at(500, 0).z_m, 40);
  recipe.kind = TerrainKind::kSlope;
  recipe.slope = {.depth_m = 50, .slope = 0.1};
  EXPECT_EQ(prepare_terrain(recipe, {}).terrain->depth_at(100, 0).z_m, 60);
}

TEST(TerrainRecipe, ReliefIsLabelledSyntheticAndChangesTheVersion) {
  TerrainRecipe recipe;
  const PreparedTerrain smooth = prepare_terrain(recipe, {});
  recipe.relief.rms_m = 4;
  const PreparedTerrain rough = prepare_terrain(recipe, {});
  EXPECT_EQ(smooth.summary.find("SYNTHETIC"), std::string::npos);
  EXPECT_NE(rough.summary.find("SYNTHETIC"), std::string::npos);
  EXPECT_NE(smooth.terrain->version(), rough.terrain->version());
  EXPECT_EQ(rough.terrain->version(), prepare_terrain(recipe, {}).terrain->version());
}

TEST(TerrainRecipe, ReadsRastersRelativeToTheScenarioAndNestsThem) {
  testing::TestRaster coarse{.name = "recipe_coarse",
                             .columns = 21,
                             .rows = 21,
                             .geotransform = std::array<double, 6>{-28.105, 0.01, 0, 30.105, 0, -0.01}};
  testing::TestRaster fine = coarse;
  fine.name = "recipe_fine";
  testing::write_raster(coarse, [](int, int) { return -400.0; });
  testing::write_raster(fine, [](int, int) { return -300.0; });
  TerrainRecipe recipe;
  recipe.kind = TerrainKind::kRaster;
  recipe.raster.path = "/vsimem/recipe_coarse.tif";
  recipe.nested.push_back({.domain = {.size_north_m = 1000, .size_east_m = 1000, .spacing_m = 10},
                           .blend_width_m = 100,
                           .raster = {.path = "/vsimem/recipe_fine.tif"}});
  const PreparedTerrain prepared = prepare_terrain(recipe, {30, -28});
  EXPECT_EQ(prepared.terrain->depth_at(0, 0).z_m, 300);
  EXPECT_EQ(prepared.terrain->depth_at(1500, 0).z_m, 400);
  EXPECT_EQ(prepared.terrain->depth_at(450, 0).z_m, 350);
  EXPECT_EQ(prepared.rasters.size(), 2u);
}

TEST(TerrainRecipe, RefusesASpacingThatDoesNotDivideTheSize) {
  TerrainRecipe recipe;
  recipe.kind = TerrainKind::kSlope;
  recipe.domain.spacing_m = 30;
  EXPECT_THROW(prepare_terrain(recipe, {}), InvalidArgument);
}

TEST(MeanWaterDepth, OfAShapeIsThatOverItsAreaAndLandIsLeftOut) {
  TerrainRecipe recipe;
  recipe.flat.depth_m = 120;
  EXPECT_EQ(mean_water_depth_m(recipe, {}, 0), 120);
  EXPECT_EQ(mean_water_depth_m(recipe, {}, -5), 125);
  recipe.kind = TerrainKind::kSlope;
  recipe.slope = {.depth_m = 600, .slope = 0.1};
  EXPECT_NEAR(mean_water_depth_m(recipe, {}, 0), 600, 1e-3);
  recipe.slope = {.depth_m = 0, .slope = 0.1};  // 4 of 9 rows lie in the water: 50, 100, 150 and 200 m
  EXPECT_NEAR(mean_water_depth_m(recipe, {}, 0), 125, 1e-3);
  recipe.slope = {.depth_m = -1000};
  EXPECT_EQ(mean_water_depth_m(recipe, {}, 0), 0);
}

}  // namespace
}  // namespace halocline::bathymetry
