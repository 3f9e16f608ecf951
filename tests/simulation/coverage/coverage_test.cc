// SPDX-License-Identifier: BSD-3-Clause
// Maps of coverage against the links they are made of.
#include "simulation/coverage/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/noise/noise_spectrum.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "core/check.h"
#include "core/random.h"
#include "core/units.h"
#include "simulation/composition.h"
#include "simulation/coverage/coverage_links.h"
#include "simulation/coverage/coverage_track.h"
#include "simulation/link_survey.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

ScenarioConfig level_sea() {
  return load_scenario(std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/shelf.toml",
                       {"modem.source_level_db=160", "terrain.size_north_m=16000",
                        "terrain.size_east_m=16000", "terrain.spacing_m=200"},
                       ScenarioUse::kWater);
}

const std::vector<CoverageQuantity> kAll{CoverageQuantity::kDelivery, CoverageQuantity::kSnr,
                                         CoverageQuantity::kLevel, CoverageQuantity::kDelay};

// Of links.
struct Differences {
  double level_db, delay_s, delivery;
  RaySharing sharing = RaySharing::kNone;
  int cells = 1000;
  // So many may differ by more: one search finds a path that the other misses, two guard windows are as good
  // as each other, or a path at the edge of a shadow is there or not by the last digit.
  int of_other_paths = 0;
};

// As far as the terrain is known. The greatest differences are those of what is interpolated; delivery at its
// flank, where it changes by 0.1 a decibel and more, has the tolerance of the level.
void expect_links_in_random_cells(const ScenarioConfig& config, const std::string& name,
                                  const CoverageArea& area, const Differences& most) {
  const LinkSurveyEnd from = link_end(config, name);
  const Coverage map =
      compute_coverage(config, make_terrain(config).terrain, from, area, kAll, /*threads=*/2, most.sharing);
  LinkSurveyEnd to = link_end(config, "0,0,0");
  int looked_at = 0, differing = 0;
  for (std::uint64_t i = 0; looked_at < most.cells; ++i) {
    ASSERT_LT(i, 20'000U);
    const auto drawn = [&](std::uint32_t what, std::size_t count) {
      const double u = uniform_at({.purpose = purpose_of("cell"), .who = what, .which = i});
      return std::min(static_cast<std::size_t>(u * static_cast<double>(count)), count - 1);
    };
    const std::size_t row = drawn(0, area.side), column = drawn(1, area.side),
                      depth = drawn(2, area.depths_m.size());
    const std::size_t cell = row * area.side + column;
    if (std::isnan(map.delivery[depth][cell])) continue;
    ++looked_at;
    to.position_ned_m = {area.north_m(row), area.east_m(column),
                         area.depths_m[depth] + config.scenario.sea_surface_z_m};
    const LinkSurvey link = survey_link(config, from, to);
    const acoustics::LinkBudget& budget = link.reception.budget;
    const bool is_equal =
        std::abs(map.level_db[depth][cell] - budget.received_level.value) <= most.level_db &&
        std::abs(map.values(CoverageQuantity::kSnr, depth)[cell] - budget.snr.value) <= most.level_db &&
        std::abs(map.delay_s[depth][cell] - budget.delay_s) <= most.delay_s &&
        std::abs(map.delivery[depth][cell] - link.forecast.delivery_probability) <= most.delivery;
    if (is_equal) continue;
    ++differing;
    EXPECT_LE(differing, most.of_other_paths)
        << to.position_ned_m.transpose() << ": level " << map.level_db[depth][cell] << " "
        << budget.received_level.value << ", delay " << map.delay_s[depth][cell] << " " << budget.delay_s
        << ", delivery " << map.delivery[depth][cell] << " " << link.forecast.delivery_probability;
  }
}

const Differences kEqual{tolerance(1e-9), tolerance(1e-12), tolerance(1e-9)};
const Differences kInterpolated{tolerance(0.1), tolerance(1e-6), tolerance(0.01)};

TEST(Coverage, OfLevelSeaEqualsLinksIn1000RandomCells) {
  CoverageArea area{.middle_north_m = -3250, .cell_m = 50, .side = 80, .depths_m = {5, 20, 40, 90}};
  Differences most = kInterpolated;
  most.of_other_paths = 2;  // one cell, drawn twice, where two guard windows are as good as each other
  expect_links_in_random_cells(level_sea(), "buoy", area, most);
}

ScenarioConfig sea_over_a_ridge() {
  ScenarioConfig config = level_sea();
  config.terrain.kind = bathymetry::TerrainKind::kRidge;
  config.terrain.ridge = {.depth_m = 100, .height_m = 60, .half_width_m = 800};
  return config;
}

TEST(Coverage, OverTerrainEqualsLinksIn1000RandomCells) {
  const CoverageArea area{.middle_north_m = -3250, .cell_m = 150, .side = 26, .depths_m = {5, 45, 90}};
  expect_links_in_random_cells(sea_over_a_ridge(), "buoy", area, kEqual);
}

TEST(Coverage, ByRaysThatDepthsShareIsCloseToLinksIn1000RandomCells) {
  const CoverageArea area{
      .middle_north_m = -3250, .cell_m = 150, .side = 26, .depths_m = depths_of("5:95:5")};
  Differences most = kInterpolated;
  most.sharing = RaySharing::kDepths;
  most.of_other_paths = 5;
  expect_links_in_random_cells(sea_over_a_ridge(), "buoy", area, most);
}

TEST(Coverage, ByAFanThatRangesShareLooksLikeThatOfLinks) {
  ScenarioConfig config = sea_over_a_ridge();
  const auto terrain = make_terrain(config).terrain;
  const CoverageArea area{.middle_north_m = -3250, .cell_m = 100, .side = 26, .depths_m = {5, 30, 60}};
  LinkSurveyEnd from = link_end(config, "buoy");
  from.modem.modem.source_level = Decibels{136};  // reaches to the middle of the map
  const Coverage links = compute_coverage(config, terrain, from, area, kAll, 2),
                 rays = compute_coverage(config, terrain, from, area, kAll, 2, RaySharing::kRanges);
  std::vector<double> off_db, off_delivery;
  for (std::size_t depth = 0; depth < area.depths_m.size(); ++depth) {
    ASSERT_TRUE(links.mean_delivery(depth));
    EXPECT_NEAR(*links.mean_delivery(depth), 0.5, 0.4);
    EXPECT_NEAR(*rays.mean_delivery(depth), *links.mean_delivery(depth), tolerance(0.01)) << depth;
    for (std::size_t cell = 0; cell < links.delivery[depth].size(); ++cell) {
      ASSERT_EQ(std::isnan(links.delivery[depth][cell]), std::isnan(rays.delivery[depth][cell]));
      if (std::isnan(links.delivery[depth][cell])) continue;
      off_db.push_back(std::abs(rays.level_db[depth][cell] - links.level_db[depth][cell]));
      off_delivery.push_back(std::abs(rays.delivery[depth][cell] - links.delivery[depth][cell]));
    }
  }
  const auto below = [](std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
  };
  EXPECT_GT(off_db.size(), 700U);
  EXPECT_LT(below(off_db, 0.5), tolerance(0.1));
  EXPECT_LT(below(off_db, 0.95), tolerance(1));
  EXPECT_LT(below(off_delivery, 0.5), tolerance(0.005));
  EXPECT_LT(below(off_delivery, 0.9), tolerance(0.05));
}

TEST(Coverage, InAnOceansFieldEqualsLinksInRandomCells) {
  const ScenarioConfig config = load_scenario(std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/front.toml",
                                              {"modem.source_level_db=160"}, ScenarioUse::kWater);
  const CoverageArea area{.middle_north_m = -3000,
                          .middle_east_m = 500,
                          .cell_m = 400,
                          .side = 10,
                          .depths_m = depths_of("20:140:10")};
  Differences most = kEqual;
  most.cells = 100;
  expect_links_in_random_cells(config, "south", area, most);
}

TEST(Coverage, AlongStraightLinesEqualsLinksIn1000RandomCells) {
  ScenarioConfig config = level_sea();
  config.channel_server.propagation.model = channel_server::PropagationModel::kStraight;
  CoverageArea area{.middle_north_m = -3250, .cell_m = 50, .side = 80, .depths_m = {5, 90}};
  expect_links_in_random_cells(config, "buoy", area, kInterpolated);
}

TEST(Coverage, AmongTheNoiseOfVehiclesEqualsLinksInRandomCells) {
  ScenarioConfig config = level_sea();
  channel_server::NoiseSource noise;
  noise.at_1m = acoustics::NoiseSpectrum({100, 100'000}, {150, 120});
  noise.driver = channel_server::NoiseDriver::kNone;
  config.channel_server.vehicles.at(0).noise = noise;
  const CoverageArea area{.middle_north_m = -3250, .cell_m = 300, .side = 12, .depths_m = {5, 45}};
  Differences most = kEqual;
  most.cells = 50;
  expect_links_in_random_cells(config, "buoy", area, most);
  const Coverage map =
      compute_coverage(config, make_terrain(config).terrain, link_end(config, "buoy"), area, kAll, 2);
  EXPECT_LT(map.values(CoverageQuantity::kSnr, 0).front(), map.level_db[0].front() - map.noise_level_db - 1);
}

// The shape lies beyond a base grid whose posts are all level.
TEST(Coverage, BeyondTheBaseGridEqualsLinksInRandomCells) {
  ScenarioConfig config = level_sea();
  config.terrain.kind = bathymetry::TerrainKind::kSeamount;
  config.terrain.seamount = {
      .depth_m = 100, .height_m = 90, .radius_m = 500, .summit_x_m = 12'000, .summit_y_m = 0};
  const CoverageArea area{.middle_north_m = 13'300, .cell_m = 100, .side = 4, .depths_m = {5, 45}};
  Differences most = kEqual;
  most.cells = 20;
  expect_links_in_random_cells(config, "10500,0,30", area, most);
}

TEST(Coverage, DoesNotDependOnTheNumberOfThreads) {
  for (const ScenarioConfig& config : {level_sea(), sea_over_a_ridge()}) {
    const auto terrain = make_terrain(config).terrain;
    const CoverageArea area{
        .middle_north_m = -3250, .cell_m = 400, .side = 8, .depths_m = {5, 20, 35, 60, 90}};
    const LinkSurveyEnd from = link_end(config, "buoy");
    const Coverage one = compute_coverage(config, terrain, from, area, kAll, 1, RaySharing::kDepths),
                   three = compute_coverage(config, terrain, from, area, kAll, 3, RaySharing::kDepths);
    const std::string kind = config.terrain.kind == bathymetry::TerrainKind::kRidge ? "ridge" : "level";
    for (std::size_t depth = 0; depth < area.depths_m.size(); ++depth) {
      for (std::size_t cell = 0; cell < one.level_db[depth].size(); ++cell) {
        if (std::isnan(one.level_db[depth][cell])) continue;
        EXPECT_EQ(one.level_db[depth][cell], three.level_db[depth][cell]) << kind;
        EXPECT_EQ(one.delay_s[depth][cell], three.delay_s[depth][cell]) << kind;
        EXPECT_EQ(one.delivery[depth][cell], three.delivery[depth][cell]) << kind;
      }
    }
  }
}

TEST(Coverage, HasNoValueBelowTheSeabedAndGoesOnBeyondTheArea) {
  const ScenarioConfig config = level_sea();
  const CoverageArea area{.middle_north_m = 7900, .cell_m = 100, .side = 4, .depths_m = {50, 101}};
  const Coverage map =
      compute_coverage(config, make_terrain(config).terrain, link_end(config, "7900,0,10"), area, kAll, 1);
  for (std::size_t cell = 0; cell < 16; ++cell) {
    EXPECT_FALSE(std::isnan(map.delivery[0][cell])) << cell;
    EXPECT_TRUE(std::isnan(map.delivery[1][cell]));
  }
  EXPECT_FALSE(map.mean_delivery(1));
}

TEST(Coverage, BestDepthIsThatOfTheGreatestMean) {
  ScenarioConfig config = level_sea();
  const CoverageArea area{.middle_north_m = 0, .cell_m = 500, .side = 16, .depths_m = {8, 50, 80}};
  const Coverage map = compute_coverage(config, make_terrain(config).terrain, link_end(config, "0,0,8"), area,
                                        {CoverageQuantity::kDelivery}, 2);
  ASSERT_TRUE(map.best_depth());
  for (std::size_t depth = 0; depth < 3; ++depth)
    EXPECT_LE(*map.mean_delivery(depth), *map.mean_delivery(*map.best_depth()));
}

TEST(Coverage, AlongATrackTheBestDepthIsBetterThanEveryOther) {
  const ScenarioConfig config = level_sea();
  const auto terrain = make_terrain(config).terrain;
  const LinkSurveyEnd from = link_end(config, "buoy");
  const std::vector<double> depths{8, 50, 90, 200};
  const std::vector<TrackPlace> track{{0, -2000, 0}, {10, 0, 500}, {20, 3000, 1000}, {30, 9000, 0}};
  const auto choices = best_depths(config, terrain, from, track, depths, 2);
  ASSERT_EQ(choices.size(), track.size());
  EXPECT_FALSE(best_depths(config, terrain, from, track, {200}, 1).front().best) << "in the bottom";
  for (std::size_t i = 0; i < track.size(); ++i) {
    ASSERT_TRUE(choices[i].best);
    for (std::size_t depth = 0; depth < 3; ++depth) {
      LinkSurveyEnd to = link_end(config, "0,0,0");
      to.position_ned_m = {track[i].north_m, track[i].east_m, depths[depth]};
      const double delivery = survey_link(config, from, to).forecast.delivery_probability;
      EXPECT_LE(delivery, choices[i].sample[0]) << i << " " << depth;
      if (depth == choices[i].best) {
        EXPECT_EQ(delivery, choices[i].sample[0]);
      }
    }
  }
}

TEST(Coverage, DepthsAreReadAndRefused) {
  EXPECT_EQ(depths_of("5:20:5"), (std::vector<double>{5, 10, 15, 20}));
  EXPECT_EQ(depths_of("0:1:0.3"), (std::vector<double>{0, 0.3, 0.6, 3 * 0.3}));
  EXPECT_EQ(depths_of("12.5"), (std::vector<double>{12.5}));
  for (const char* text : {"", "5:", "5:4:1", "-1:5:1", "1:5:0", "1:5", "a", "1:2:3:4", "0:1e9:1"})
    EXPECT_THROW(depths_of(text), InvalidArgument) << text;
}

TEST(Coverage, QuantitiesAreReadAndRefused) {
  EXPECT_EQ(quantities_of("snr,delivery"),
            (std::vector<CoverageQuantity>{CoverageQuantity::kSnr, CoverageQuantity::kDelivery}));
  EXPECT_EQ(quantities_of("delivery_low,delivery_high"),
            (std::vector<CoverageQuantity>{CoverageQuantity::kDeliveryLow, CoverageQuantity::kDeliveryHigh}));
  for (const char* text : {"", "snr,snr", "loudness", "snr,,level"})
    EXPECT_THROW(quantities_of(text), InvalidArgument) << text;
}

// A raster of 2 km by 2 km in a map of 4 km by 4 km: a quarter of the cells.
TEST(CoverageMap, SaysWhereTheTerrainEnds) {
  const std::string path = ::testing::TempDir() + "coverage-" + std::to_string(getpid()) + ".asc";
  std::ofstream raster(path);
  raster << "ncols 21\nnrows 21\nxllcorner -1050\nyllcorner -1050\ncellsize 100\n";
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 21; ++j) raster << -80 - i << " ";
    raster << "\n";
  }
  raster.close();
  ScenarioConfig config = level_sea();
  config.terrain = {};
  config.terrain.kind = bathymetry::TerrainKind::kRaster;
  config.terrain.whole_file = true;
  config.terrain.raster.path = path;
  config.terrain.raster.coordinate_system = "local";
  const CoverageArea area{0, 0, 500, 8, {40}};
  const auto map = [&] {
    return compute_coverage(config, make_terrain(config).terrain, link_end(config, "0,0,40"), area,
                            {CoverageQuantity::kDelivery}, /*threads=*/2);
  };
  const auto known = [](const Coverage& coverage) {
    return std::count_if(coverage.delivery[0].begin(), coverage.delivery[0].end(),
                         [](double value) { return !std::isnan(value); });
  };
  const Coverage held = map();
  config.channel_server.propagation.rays.holds_terrain = false;
  const Coverage ended = map();
  std::filesystem::remove(path);
  EXPECT_EQ(held.cells_beyond_terrain, 48U);
  EXPECT_EQ(ended.cells_beyond_terrain, 48U);
  EXPECT_EQ(known(held), 64);
  EXPECT_EQ(known(ended), 16);
}

}  // namespace
}  // namespace halocline::clients
