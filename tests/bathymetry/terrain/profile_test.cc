// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/profile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "core/check.h"
#include "core/huge_page_vector.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;
using testing::kNoData;

const Terrain& rugged_terrain() {
  static const Terrain terrain(testing::rugged_grid(129));
  return terrain;
}

TEST(UniformProfile, SamplesBothEndsAndEvenlyBetween) {
  const auto points = uniform_profile(rugged_terrain(), {100, 200}, {700, 1000}, 11);
  ASSERT_EQ(points.size(), 11u);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double s = static_cast<double>(k) / 10;
    EXPECT_NEAR(points[k].distance_m, 1000 * s, tolerance(1e-9));
    EXPECT_NEAR(points[k].z_m, rugged_terrain().depth_at(100 + 600 * s, 200 + 800 * s).z_m, tolerance(1e-9));
  }
}

TEST(UniformProfile, MarksTheSamplesOutside) {
  const auto points = uniform_profile(rugged_terrain(), {-100, 50}, {100, 50}, 5);
  EXPECT_EQ(points[0].status, DepthStatus::kOutside);
  EXPECT_TRUE(std::isnan(points[0].z_m));
  EXPECT_EQ(points[2].status, DepthStatus::kOk);
}

// From outside over a nested grid and a hole to outside.
TEST(UniformProfile, HasTheDepthsOfItsPointsBitByBit) {
  HeightGrid with_hole = testing::rugged_grid(129);
  with_hole.posts_for_editing()[with_hole.index(64, 64)] = kNoData;
  std::vector<NestedGrid> nested;
  nested.push_back({make_grid({200, 200, 5, 41, 41}, FlatShape{.depth_m = 100}), 50});
  const Terrain one_grid(with_hole), two_grids(with_hole, std::move(nested));
  for (const Terrain* terrain : {&one_grid, &two_grids}) {
    for (const std::size_t count : {2, 63, 64, 65, 1000}) {
      const PlanePoint from{-40, -40}, to{1280.1, 1280};
      const auto points = uniform_profile(*terrain, from, to, count);
      std::array<int, 4> statuses{};
      for (std::size_t k = 0; k < count; ++k) {
        const auto n = static_cast<double>(k), last = static_cast<double>(count - 1);
        const bool ends = k + 1 == count;
        const DepthSample sample =
            terrain->depth_at(ends ? to.x_m : from.x_m + n * ((to.x_m - from.x_m) / last),
                              ends ? to.y_m : from.y_m + n * ((to.y_m - from.y_m) / last));
        EXPECT_EQ(points[k].status, sample.status) << k << " of " << count;
        EXPECT_EQ(std::bit_cast<std::uint64_t>(points[k].z_m), std::bit_cast<std::uint64_t>(sample.z_m))
            << k << " of " << count;
        ++statuses[static_cast<std::size_t>(sample.status)];
      }
      if (count == 1000) {
        EXPECT_TRUE(statuses[0] > 900 && statuses[1] > 20 && statuses[2] > 5);
      }
    }
  }
}

TEST(UniformProfile, RefusesFewerThanTwoSamples) {
  EXPECT_THROW(uniform_profile(rugged_terrain(), {0, 0}, {1, 1}, 1), InvalidArgument);
}

TEST(UniformProfile, OfInfiniteLengthIsBadInput) {
  const auto points = uniform_profile(rugged_terrain(), {0, 0}, {HUGE_VAL, 1}, 3);
  EXPECT_EQ(points.back().status, DepthStatus::kBadInput);
}

TEST(ExactProfile, HasAPointAtEveryCrossing) {
  const auto points = exact_profile(rugged_terrain(), {5, 5}, {5, 95});
  for (double y = 10; y <= 90; y += 10) {
    EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](const ProfilePoint& p) {
      return std::abs(p.distance_m - (y - 5)) < 1e-9;
    })) << y;
  }
  EXPECT_EQ(points.front().distance_m, 0);
  EXPECT_EQ(points.back().distance_m, 90);
}

TEST(ExactProfile, SeesTheRidgeThatEvenSamplesMiss) {
  HugePageVector<float> posts(101 * 3, 200.0f);
  posts[50 * 3] = posts[50 * 3 + 1] = posts[50 * 3 + 2] = 20;  // at x = 500
  const Terrain terrain(HeightGrid({0, 0, 10, 101, 3}, posts));
  const auto shallowest = [](const std::vector<ProfilePoint>& points) {
    return std::min_element(points.begin(), points.end(), [](auto& p, auto& q) { return p.z_m < q.z_m; })
        ->z_m;
  };
  EXPECT_EQ(shallowest(uniform_profile(terrain, {30, 10}, {970, 10}, 22)), 200);
  EXPECT_EQ(shallowest(exact_profile(terrain, {30, 10}, {970, 10})), 20);
}

TEST(ExactProfile, FindsTheSummitInsideACell) {
  // Along the diagonal u = v the depth is 20 u (1 - u) + 20 u (1 - u) = 40 u (1 - u): 10 in the middle.
  const Terrain terrain(testing::small_grid({0, 20, 0, 20, 0, 0, 0, 0, 0}));
  const auto points = exact_profile(terrain, {0, 0}, {10, 10});
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[1].distance_m, std::hypot(5, 5), tolerance(1e-12));
  EXPECT_NEAR(points[1].z_m, 10, tolerance(1e-12));
}

TEST(ExactProfile, BoundsWhatDenseSamplesSee) {
  const PlanePoint from{13, 1200}, to{1250, 33};
  const auto exact = exact_profile(rugged_terrain(), from, to);
  const auto dense = uniform_profile(rugged_terrain(), from, to, 200'001);
  const auto depth_less = [](const ProfilePoint& p, const ProfilePoint& q) { return p.z_m < q.z_m; };
  const auto [low, high] = std::minmax_element(exact.begin(), exact.end(), depth_less);
  const auto [dense_low, dense_high] = std::minmax_element(dense.begin(), dense.end(), depth_less);
  EXPECT_LE(low->z_m, dense_low->z_m + tolerance(1e-9));
  EXPECT_GE(high->z_m, dense_high->z_m - tolerance(1e-9));
  // Samples 8 mm apart on slopes below 3 come within 25 mm of the extremes.
  EXPECT_NEAR(low->z_m, dense_low->z_m, tolerance(0.025));
  EXPECT_NEAR(high->z_m, dense_high->z_m, tolerance(0.025));
}

TEST(ExactProfile, LiesOnTheSurfaceAndInOrder) {
  const auto points = exact_profile(rugged_terrain(), {13, 1200}, {1250, 33});
  const double length = std::hypot(1237, 1167);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double s = points[n].distance_m / length;
    EXPECT_NEAR(points[n].z_m, rugged_terrain().depth_at(13 + 1237 * s, 1200 - 1167 * s).z_m, tolerance(1e-8))
        << n;
    if (n > 0) {
      EXPECT_GT(points[n].distance_m, points[n - 1].distance_m) << n;
    }
  }
}

TEST(ExactProfile, MarksAGapByItsFirstAndLastPoint) {
  HugePageVector<float> posts(9, 100.0f);
  posts[8] = kNoData;  // at (20, 20): the last cell
  const auto points = exact_profile(Terrain(testing::small_grid(posts)), {15, -7}, {15, 27});
  std::vector<DepthStatus> statuses;
  for (const ProfilePoint& point : points) statuses.push_back(point.status);
  using enum DepthStatus;
  EXPECT_EQ(statuses, (std::vector{kOutside, kOutside, kOk, kOk, kNoData, kNoData, kOutside, kOutside}));
  EXPECT_EQ(points[1].distance_m, 7);
  EXPECT_EQ(points[2].distance_m, 7);
  EXPECT_EQ(points[3].distance_m, 17);
  EXPECT_EQ(points[5].distance_m, 27);
}

TEST(ExactProfile, OfAPointIsThatPoint) {
  const auto points = exact_profile(rugged_terrain(), {100, 100}, {100, 100});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].z_m, rugged_terrain().depth_at(100, 100).z_m);
}

TEST(ExactProfile, NotFiniteIsBadInput) {
  const auto points = exact_profile(rugged_terrain(), {0, std::nan("")}, {1, 1});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].status, DepthStatus::kBadInput);
}

TEST(ExactProfile, AlongAGridLineFollowsItsPosts) {
  const auto points = exact_profile(rugged_terrain(), {50, 0}, {50, 100});
  ASSERT_EQ(points.size(), 11u);
  for (int j = 0; j <= 10; ++j) {
    EXPECT_NEAR(points[static_cast<std::size_t>(j)].z_m, rugged_terrain().grid(0).post(5, j),
                tolerance(1e-9));
  }
}

}  // namespace
}  // namespace halocline::bathymetry
