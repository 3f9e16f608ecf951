// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/tile_service.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"

namespace halocline::bathymetry {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

// 640 m by 640 m from the origin, posts 10 m apart.
const Terrain& rugged() {
  static const Terrain terrain(testing::rugged_grid(65));
  return terrain;
}

Terrain flat(int posts_x, int posts_y, double spacing_m) {
  return Terrain(make_grid(
      {.first_x_m = -100, .first_y_m = 50, .spacing_m = spacing_m, .posts_x = posts_x, .posts_y = posts_y},
      FlatShape{.depth_m = 80}));
}

TEST(TileService, PostsAreTheDepthsOfTheTerrainRowByRowFromTheSouthWest) {
  const Tile tile = answer(rugged(), {12.5, 30, 7, 20, 11});
  ASSERT_EQ(tile.refusal, "");
  ASSERT_EQ(tile.z_m.size(), 220u);
  for (std::size_t i = 0; i < 20; ++i) {
    for (std::size_t j = 0; j < 11; ++j) {
      const double z =
          rugged().depth_at(12.5 + 7.0 * static_cast<double>(i), 30 + 7.0 * static_cast<double>(j)).z_m;
      EXPECT_EQ(tile.z_m[i * 11 + j], static_cast<float>(z)) << i << " " << j;
      EXPECT_EQ(tile.known[i * 11 + j], 1);
    }
  }
}

TEST(TileService, PostsOutsideOfTheTerrainOrWithoutDataAreNotKnown) {
  const auto nan = std::numeric_limits<float>::quiet_NaN();
  const Terrain terrain(testing::small_grid({1, 2, 3, 4, 5, 6, 7, 8, nan}));
  const Tile tile = answer(terrain, {0, -10, 10, 3, 3});  // the first column lies to the west of the terrain
  EXPECT_EQ(tile.known, (std::vector<std::int8_t>{0, 1, 1, 0, 1, 0, 0, 1, 0}));
  EXPECT_EQ(tile.z_m, (std::vector<float>{0, 1, 2, 0, 4, 0, 0, 7, 0}));
}

TEST(TileService, APostOnTheEdgeIsKnownWhateverTheRounding) {
  const Terrain terrain = flat(31, 31, 0.1);
  const Tile tile = answer(terrain, {-100, 50, 0.1, 31, 31});
  EXPECT_EQ(tile.known, std::vector<std::int8_t>(961, 1));
}

// The whole extent but for what is left over of the shorter side, which is less than the spacing.
TEST(TileService, TheOverviewCoversTheTerrainInAtMost97PostsEitherWay) {
  const std::pair<int, int> sizes[] = {{2, 2},     {65, 65},   {97, 97},   {98, 98},
                                       {401, 401}, {1000, 37}, {3, 20'000}};
  for (const auto& [posts_x, posts_y] : sizes) {
    const Terrain terrain = flat(posts_x, posts_y, 20);
    const Tile tile = overview(terrain);
    const auto& q = tile.query;
    SCOPED_TRACE(std::to_string(posts_x) + " x " + std::to_string(posts_y));
    EXPECT_EQ(q.south_m, -100);
    EXPECT_EQ(q.west_m, 50);
    EXPECT_EQ(std::max(q.rows, q.columns), std::min(std::max(posts_x, posts_y), kMaxOverviewPosts));
    EXPECT_GE(q.spacing_m, 20);
    for (const auto& [posts, all] : {std::pair(q.rows, posts_x), {q.columns, posts_y}}) {
      const double left = 20.0 * (all - 1) - q.spacing_m * static_cast<double>(posts - 1);
      EXPECT_GE(left, -1e-6);
      EXPECT_LT(left, q.spacing_m);
    }
    EXPECT_EQ(tile.known, std::vector<std::int8_t>(static_cast<std::size_t>(q.rows * q.columns), 1));
  }
}

TEST(TileService, TheFinestSpacingIsThatOfTheFinestGrid) {
  std::vector<NestedGrid> nested;
  nested.push_back(
      {make_grid({.first_x_m = 100, .first_y_m = 100, .spacing_m = 2, .posts_x = 51, .posts_y = 51},
                 FlatShape{.depth_m = 290})});
  EXPECT_EQ(finest_spacing_m(Terrain(testing::rugged_grid(65), std::move(nested))), 2);
  EXPECT_EQ(finest_spacing_m(rugged()), 10);
}

TEST(TileService, TakesTheCapOfPostsAndRefusesMoreWithTheLimit) {
  EXPECT_EQ(answer(rugged(), {0, 0, 1, 100, 100}).z_m.size(), static_cast<std::size_t>(kMaxPosts));
  EXPECT_EQ(answer(rugged(), {0, 0, 1, 1, kMaxPosts}).refusal, "");
  for (const auto& [rows, columns] : {std::pair(101, 100), {10'000, 2}, {2, 10'000}}) {
    const Tile tile = answer(rugged(), {0, 0, 1, rows, columns});
    EXPECT_THAT(tile.refusal, HasSubstr("allowed is 1 to 10000"));
    EXPECT_TRUE(tile.z_m.empty());
  }
}

struct BadQuery {
  TileQuery query;
  std::string field, allowed;
};

TEST(TileService, RefusesWhatCannotBeAndNamesFieldAndRange) {
  constexpr std::int64_t kHuge = std::numeric_limits<std::int32_t>::max(),
                         kMin = std::numeric_limits<std::int32_t>::min();
  const BadQuery bad[] = {
      {{kNan, 0, 10, 5, 5}, "corner_north_m is nan", "-40 to 640"},
      {{0, kInfinity, 10, 5, 5}, "corner_east_m is inf", "-40 to 640"},
      {{641, 0, 10, 5, 5}, "corner_north_m is 641", "-40 to 640"},
      {{0, -41, 10, 5, 5}, "corner_east_m is -41", "-40 to 640"},
      {{0, 0, kNan, 5, 5}, "post_spacing_m is nan", "above 0 to 1e+06"},
      {{0, 0, 0, 5, 5}, "post_spacing_m is 0", "above 0"},
      {{600, 600, -10, 5, 5}, "post_spacing_m is -10", "above 0"},
      {{0, 0, kInfinity, 5, 5}, "post_spacing_m is inf", "1e+06"},
      {{0, 0, 10, 0, 5}, "requested_rows is 0", "1 to 10000"},
      {{0, 0, 10, kMin, 5}, "requested_rows is -2147483648", "1 to 10000"},
      {{0, 0, 10, 5, -1}, "requested_columns is -1", "1 to 10000"},
      {{0, 0, 10, kHuge, kHuge}, "requested_rows is 2147483647", "1 to 10000"},
  };
  for (const BadQuery& one : bad) {
    const Tile tile = answer(rugged(), one.query);
    EXPECT_THAT(tile.refusal, HasSubstr(one.field));
    EXPECT_THAT(tile.refusal, HasSubstr(one.allowed));
    EXPECT_TRUE(tile.z_m.empty());
    EXPECT_EQ(tile.query.rows * tile.query.columns, 0);
  }
}

}  // namespace
}  // namespace halocline::bathymetry
