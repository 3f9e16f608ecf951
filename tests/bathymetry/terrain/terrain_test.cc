// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/terrain.h"

#include <cmath>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "core/check.h"
#include "core/huge_page_vector.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;
using testing::kNoData;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// x and y from -100 to 100.
GridGeometry square_of_200_m() { return {-100, -100, 10, 21, 21}; }

Terrain flat_terrain() { return Terrain(make_grid(square_of_200_m(), FlatShape{.depth_m = 100})); }

TEST(TerrainDepth, IsBilinearInACell) {
  const Terrain terrain(testing::small_grid({0, 4, 0, 8, 20, 0, 0, 0, 0}));
  // (0.25, 0.5) of the first cell: 0 * .75 * .5 + 8 * .25 * .5 + 4 * .75 * .5 + 20 * .25 * .5 = 5.
  EXPECT_DOUBLE_EQ(terrain.depth_at(2.5, 5).z_m, 5);
}

TEST(TerrainDepth, IsThePostItselfOnAPost) {
  const Terrain terrain(testing::small_grid({0, 1, 2, 3, 4, 5, 6, 7, 8}));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_EQ(terrain.depth_at(10 * i, 10 * j).z_m, 3 * i + j);
  }
}

TEST(TerrainDepth, GivesTheSlopeOfAPlane) {
  const Terrain terrain(
      make_grid(square_of_200_m(), SlopeShape{.depth_m = 50, .slope = 0.25, .azimuth_rad = 0}));
  const DepthSample sample = terrain.depth_at(33, -21);
  // Posts are float: 50 m +- 4e-6, over 10 m.
  EXPECT_NEAR(sample.slope_north, 0.25, tolerance(1e-6));
  EXPECT_NEAR(sample.slope_east, 0, tolerance(1e-6));
}

TEST(TerrainDepth, NormalPointsIntoTheWaterAndDownhill) {
  const Terrain terrain(
      make_grid(square_of_200_m(), SlopeShape{.depth_m = 50, .slope = 1, .azimuth_rad = 0}));
  const Vec3 normal = terrain.depth_at(5, 5).normal_ned();
  EXPECT_NEAR(normal.norm(), 1, tolerance(1e-15));
  EXPECT_NEAR(normal.x(), std::sqrt(0.5), tolerance(1e-6));
  EXPECT_NEAR(normal.z(), -std::sqrt(0.5), tolerance(1e-6));
}

TEST(TerrainDepth, EdgesBelongToTheTerrainAndBeyondIsOutside) {
  const Terrain terrain = flat_terrain();
  EXPECT_EQ(terrain.depth_at(100, -100).status, DepthStatus::kOk);
  EXPECT_EQ(terrain.depth_at(100.001, 0).status, DepthStatus::kOutside);
  EXPECT_EQ(terrain.depth_at(0, -100.001).status, DepthStatus::kOutside);
  EXPECT_TRUE(std::isnan(terrain.depth_at(0, 1e9).z_m));
}

TEST(TerrainDepth, NothingIsInterpolatedNextToNoData) {
  const Terrain terrain(testing::small_grid({kNoData, 1, 1, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(terrain.depth_at(9.9, 9.9).status, DepthStatus::kNoData);
  EXPECT_TRUE(std::isnan(terrain.depth_at(9.9, 9.9).z_m));
  EXPECT_EQ(terrain.depth_at(10.1, 9.9).status, DepthStatus::kOk);
}

TEST(TerrainDepth, NotFiniteIsBadInput) {
  EXPECT_EQ(flat_terrain().depth_at(kNaN, 0).status, DepthStatus::kBadInput);
  EXPECT_EQ(flat_terrain().depth_at(0, -kInfinity).status, DepthStatus::kBadInput);
}

TEST(TerrainRay, HitsAFlatBottomAtTheRightRange) {
  const RayHit hit = flat_terrain().closest_hit({{0, 0, 40}, {3, 0, 4}, 500});
  EXPECT_EQ(hit.status, RayStatus::kHit);
  EXPECT_NEAR(hit.range_m, 75, tolerance(1e-12));  // 60 m down at 4/5
  EXPECT_EQ(hit.normal_ned, Vec3(0, 0, -1));
}

TEST(TerrainRay, HitsAPlaneAtTheRightRangeFromEveryDirection) {
  const Terrain terrain(
      make_grid(square_of_200_m(), SlopeShape{.depth_m = 50, .slope = 0.5, .azimuth_rad = 0}));
  for (int k = 0; k < 64; ++k) {
    const double azimuth = k * 0.0981747704;  // 2 pi / 64, so that axes and diagonals are among them
    const Vec3 d = Vec3(std::cos(azimuth), std::sin(azimuth), 1).normalized();
    // 20 + t dz = 50 + 0.5 t dx
    const double expected = 30 / (d.z() - 0.5 * d.x());
    EXPECT_NEAR(terrain.closest_hit({{0, 0, 20}, d, 500}).range_m, expected, tolerance(1e-4))
        << k;  // float posts
  }
}

TEST(TerrainRay, MissesWhatLiesBeyondItsRange) {
  const RayHit hit = flat_terrain().closest_hit({{0, 0, 40}, {0, 0, 1}, 59.999});
  EXPECT_EQ(hit.status, RayStatus::kMiss);
  EXPECT_EQ(hit.range_m, 59.999);
}

TEST(TerrainRay, LeavesTheTerrainAsOutsideWithTheRangeOfTheEdge) {
  const RayHit hit = flat_terrain().closest_hit({{0, 20, 40}, {0, 1, 0}, 500});
  EXPECT_EQ(hit.status, RayStatus::kOutside);
  EXPECT_NEAR(hit.range_m, 80, tolerance(1e-12));
}

TEST(TerrainRay, ThatBeginsOutsideIsOutsideEvenWhenItPointsIn) {
  const RayHit hit = flat_terrain().closest_hit({{0, 120, 40}, {0, -1, 1}, 500});
  EXPECT_EQ(hit.status, RayStatus::kOutside);
  EXPECT_EQ(hit.range_m, 0);
}

TEST(TerrainRay, UpwardsEndsAtItsRangeOrTheEdgeOnly) {
  EXPECT_EQ(flat_terrain().closest_hit({{0, 0, 40}, {0, 0, -1}, 500}).status, RayStatus::kMiss);
  EXPECT_EQ(flat_terrain().closest_hit({{0, 0, 40}, {1, 0, -1}, 500}).status, RayStatus::kOutside);
}

TEST(TerrainRay, BelowTheBottomIsReportedWithoutARange) {
  const RayHit hit = flat_terrain().closest_hit({{0, 0, 100.5}, {0, 0, -1}, 500});
  EXPECT_EQ(hit.status, RayStatus::kStartedBelowBottom);
  EXPECT_TRUE(std::isnan(hit.range_m));
}

TEST(TerrainRay, OnTheBottomHitsAtOnce) {
  EXPECT_EQ(flat_terrain().closest_hit({{0, 0, 100}, {1, 0, 0}, 50}).status, RayStatus::kHit);
  EXPECT_EQ(flat_terrain().closest_hit({{0, 0, 100}, {1, 0, 0}, 50}).range_m, 0);
}

TEST(TerrainRay, ComingOverNoDataEndsThereAtAnyDepth) {
  HugePageVector<float> posts(9, 100.0f);
  posts[2] = kNoData;  // north 0, east 20
  const Terrain terrain(testing::small_grid(posts));
  for (const double z : {-50.0, 0.0, 99.0}) {
    const RayHit hit = terrain.closest_hit({{5, 5, z}, {0, 1, 0}, 500});
    EXPECT_EQ(hit.status, RayStatus::kNoData) << z;
    EXPECT_NEAR(hit.range_m, 5, tolerance(1e-12)) << z;
  }
}

TEST(TerrainRay, ThatHitsBeforeNoDataIsAHit) {
  HugePageVector<float> posts(9, 100.0f);
  posts[2] = kNoData;
  EXPECT_EQ(Terrain(testing::small_grid(posts)).closest_hit({{5, 5, 98}, {0, 1, 1}, 500}).status,
            RayStatus::kHit);
}

TEST(TerrainRay, ThatBeginsOverNoDataIsNoData) {
  HugePageVector<float> posts(9, 100.0f);
  posts[4] = kNoData;
  const RayHit hit = Terrain(testing::small_grid(posts)).closest_hit({{5, 5, 10}, {0, 0, 1}, 500});
  EXPECT_EQ(hit.status, RayStatus::kNoData);
  EXPECT_EQ(hit.range_m, 0);
}

TEST(TerrainRay, ImpossibleInputIsRefusedAsBad) {
  const Terrain terrain = flat_terrain();
  for (const Ray& ray : {Ray{{kNaN, 0, 0}, {0, 0, 1}, 10}, Ray{{0, 0, kInfinity}, {0, 0, 1}, 10},
                         Ray{{0, 0, 0}, {0, 0, 0}, 10}, Ray{{0, 0, 0}, {0, kNaN, 1}, 10},
                         Ray{{0, 0, 0}, {0, 0, 1}, -1}, Ray{{0, 0, 0}, {0, 0, 1}, kInfinity}}) {
    EXPECT_EQ(terrain.closest_hit(ray).status, RayStatus::kBadInput);
  }
}

TEST(TerrainRay, AlongEveryEdgeOfTheTerrainStaysInside) {
  const Terrain terrain = flat_terrain();
  for (const double edge : {-100.0, 100.0}) {
    EXPECT_EQ(terrain.closest_hit({{edge, 0, 10}, {0, 0, 1}, 500}).status, RayStatus::kHit) << edge;
    EXPECT_EQ(terrain.closest_hit({{0, edge, 10}, {0, 0, 1}, 500}).status, RayStatus::kHit) << edge;
    EXPECT_EQ(terrain.closest_hit({{edge, 0, 10}, {0, 1, 0}, 50}).status, RayStatus::kMiss) << edge;
  }
  EXPECT_EQ(terrain.closest_hit({{100, 100, 10}, {0, 0, 1}, 500}).status, RayStatus::kHit);
}

TEST(TerrainRay, AOneCellRidgeBetweenSamplesIsNotTunnelled) {
  HugePageVector<float> posts(101 * 3, 200.0f);
  posts[50 * 3] = posts[50 * 3 + 1] = posts[50 * 3 + 2] = 20;
  const Terrain terrain(HeightGrid({0, 0, 10, 101, 3}, posts));
  const RayHit hit = terrain.closest_hit({{0, 10, 21}, {1, 0, 0}, 900});
  EXPECT_EQ(hit.status, RayStatus::kHit);
  EXPECT_NEAR(hit.range_m, 500 - 10.0 / 180, tolerance(1e-9));
}

TEST(TerrainVersion, IsTheSameForTheSameContentAndMovesWithEveryPost) {
  const HugePageVector<float> posts{1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::uint64_t version = Terrain(testing::small_grid(posts)).version();
  EXPECT_EQ(version, Terrain(testing::small_grid(posts)).version());
  for (std::size_t n = 0; n < posts.size(); ++n) {
    HugePageVector<float> changed = posts;
    changed[n] = std::nextafter(changed[n], 100.0f);
    EXPECT_NE(version, Terrain(testing::small_grid(changed)).version()) << n;
  }
}

TEST(TerrainGrid, RefusesWhatIsNoGrid) {
  EXPECT_THROW(HeightGrid({0, 0, 10, 1, 5}, HugePageVector<float>(5)), InvalidArgument);
  EXPECT_THROW(HeightGrid({0, 0, 10, 2, 2}, HugePageVector<float>(5)), InvalidArgument);
  EXPECT_THROW(HeightGrid({0, 0, 0, 2, 2}, HugePageVector<float>(4)), InvalidArgument);
  EXPECT_THROW(HeightGrid({0, kNaN, 1, 2, 2}, HugePageVector<float>(4)), InvalidArgument);
  EXPECT_THROW(HeightGrid({0, 0, 1, 2, 2}, HugePageVector<float>(4, HUGE_VALF)), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry
