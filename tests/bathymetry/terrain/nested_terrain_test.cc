// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/terrain.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/random.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;
using testing::kNoData;

// Posts are float: at 300 m they round by 1.5e-5 m, and a border post may differ from the surface by that.
constexpr double kFloatStepM = 3.1e-5;

HeightGrid coarse() { return testing::rugged_grid(41, 50); }  // 2 km, 50 m

// 10 m posts over x, y from 500 to 1500, 40 m shallower than anything around.
HeightGrid fine() { return make_grid({500, 500, 10, 101, 101}, FlatShape{.depth_m = 60}); }

Terrain nested_terrain(double blend_width_m) {
  std::vector<NestedGrid> nested;
  nested.push_back({fine(), blend_width_m});
  return Terrain(coarse(), std::move(nested));
}

TEST(NestedTerrain, MeetsTheSurfaceAroundAlongItsWholeBorder) {
  const Terrain terrain = nested_terrain(200), around(coarse());
  for (double s = 500; s <= 1500; s += 3.7) {
    for (const auto& [x, y] : {std::pair{500.0, s}, {1500.0, s}, {s, 500.0}, {s, 1500.0}}) {
      EXPECT_NEAR(terrain.depth_at(x, y).z_m, around.depth_at(x, y).z_m, tolerance(kFloatStepM))
          << x << " " << y;
    }
  }
}

TEST(NestedTerrain, BlendsLinearlyFromItsBorder) {
  const Terrain terrain = nested_terrain(200), around(coarse());
  const double z_around = around.depth_at(550, 1000).z_m;  // a quarter of the way in
  EXPECT_NEAR(terrain.depth_at(550, 1000).z_m, z_around + 0.25 * (60 - z_around), tolerance(kFloatStepM));
}

TEST(NestedTerrain, IsItselfInsideTheBlend) {
  EXPECT_EQ(nested_terrain(200).depth_at(701, 1000).z_m, 60);
  EXPECT_EQ(nested_terrain(0).depth_at(511, 1000).z_m, 60);
}

TEST(NestedTerrain, LeavesTheRestAsItWas) {
  const Terrain terrain = nested_terrain(200), around(coarse());
  EXPECT_EQ(terrain.depth_at(499, 1000).z_m, around.depth_at(499, 1000).z_m);
}

// Down the ray by small steps: the surface that depth_at shows must be the one that rays meet.
double range_by_stepping(const Terrain& terrain, const Ray& ray) {
  for (double t = 0; t <= ray.max_range_m; t += 0.25) {
    const Vec3 p = ray.origin_ned_m + t * ray.direction;
    const DepthSample sample = terrain.depth_at(p.x(), p.y());
    if (sample.status != DepthStatus::kOk) return -1;
    if (p.z() >= sample.z_m) return t;
  }
  return -1;
}

TEST(NestedTerrain, RaysMeetTheSurfaceThatDepthsShow) {
  const Terrain terrain = nested_terrain(200);
  int hits = 0;
  for (std::uint64_t n = 0; n < 1500; ++n) {
    const auto draw = [&](std::uint32_t what, double low, double high) {
      return low + (high - low) * uniform_at({.seed = 3, .who = what, .which = n});
    };
    const Vec3 from(draw(0, 10, 1990), draw(1, 10, 1990), draw(2, 0, 50));
    const double azimuth = draw(3, -4, 4), down = draw(4, 0.05, 1.5);
    const Ray ray{
        from, {std::cos(azimuth) * std::cos(down), std::sin(azimuth) * std::cos(down), std::sin(down)}, 2000};
    const double stepped = range_by_stepping(terrain, ray);
    const RayHit hit = terrain.closest_hit(ray);
    if (stepped < 0) continue;
    ++hits;
    ASSERT_EQ(hit.status, RayStatus::kHit) << n;
    EXPECT_LE(hit.range_m, stepped) << n;
    const Vec3 at = ray.origin_ned_m + hit.range_m * ray.direction;
    EXPECT_NEAR(terrain.depth_at(at.x(), at.y()).z_m, at.z(), tolerance(kFloatStepM)) << n;
  }
  EXPECT_GT(hits, 500);
}

TEST(NestedTerrain, NoDataUnderANestedGridIsNotSeen) {
  HeightGrid base = make_grid({0, 0, 50, 41, 41}, FlatShape{.depth_m = 100});
  base.posts_for_editing()[base.index(20, 20)] = kNoData;  // at (1000, 1000)
  std::vector<NestedGrid> nested;
  nested.push_back({fine(), 100});
  const Terrain terrain(std::move(base), std::move(nested));
  EXPECT_EQ(terrain.depth_at(1010, 1010).status, DepthStatus::kOk);
  const RayHit hit = terrain.closest_hit({{100, 1010, 50}, {1, 0, 0}, 1800});
  EXPECT_EQ(hit.status, RayStatus::kMiss);
}

TEST(NestedTerrain, HolesStayOrAreFilledFromAroundAsChosen) {
  HeightGrid with_hole = fine();
  with_hole.posts_for_editing()[with_hole.index(50, 50)] = kNoData;
  for (const Holes holes : {Holes::kKeep, Holes::kFillFromAround}) {
    std::vector<NestedGrid> nested;
    nested.push_back({with_hole, 100, holes});
    const Terrain terrain(coarse(), std::move(nested));
    const DepthSample sample = terrain.depth_at(1000, 1000);
    if (holes == Holes::kKeep) {
      EXPECT_EQ(sample.status, DepthStatus::kNoData);
    } else {
      EXPECT_NEAR(sample.z_m, Terrain(coarse()).depth_at(1000, 1000).z_m, tolerance(kFloatStepM));
    }
  }
}

TEST(NestedTerrain, GridsNestInGridsThatAreNested) {
  std::vector<NestedGrid> nested;
  nested.push_back({fine(), 100});
  nested.push_back({make_grid({900, 900, 2, 101, 101}, FlatShape{.depth_m = 20}), 0});
  const Terrain terrain(coarse(), std::move(nested));
  EXPECT_EQ(terrain.depth_at(1000, 1000).z_m, 20);
  const RayHit hit = terrain.closest_hit({{600, 1000, 40}, {1, 0, 0}, 1000});
  EXPECT_EQ(hit.status, RayStatus::kHit);
  EXPECT_NEAR(hit.range_m, 301, tolerance(1e-6));  // half way up the wall of one 2 m cell, from 60 m to 20 m
}

TEST(NestedTerrain, RefusesGridsThatDoNotFit) {
  const auto refuses = [](const GridGeometry& geometry) {
    std::vector<NestedGrid> nested;
    nested.push_back({make_grid(geometry, FlatShape{}), 0});
    EXPECT_THROW(Terrain(coarse(), std::move(nested)), InvalidArgument);
  };
  refuses({510, 500, 10, 101, 101});   // begins inside a coarse cell
  refuses({500, 500, 10, 100, 101});   // ends inside one
  refuses({500, 500, 30, 101, 101});   // 50 is no multiple of 30
  refuses({1500, 500, 10, 101, 101});  // reaches out
  refuses({500, 500, 100, 11, 11});    // coarser than what it lies in
}

TEST(NestedTerrain, RefusesGridsThatOverlapBesideEachOther) {
  std::vector<NestedGrid> nested;
  nested.push_back({fine(), 0});
  nested.push_back({make_grid({1000, 1000, 10, 101, 101}, FlatShape{}), 0});
  EXPECT_THROW(Terrain(coarse(), std::move(nested)), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry
