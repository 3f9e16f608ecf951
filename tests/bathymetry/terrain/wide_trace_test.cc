// SPDX-License-Identifier: BSD-3-Clause
// Rays in batches against single rays: every bit of every answer, for every vector unit of this processor.
#include "bathymetry/terrain/wide_trace.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/terrain.h"
#include "core/frames.h"
#include "core/huge_page_vector.h"
#include "core/random.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"

namespace halocline::bathymetry {
namespace {

using testing::kNoData;

double draw(std::uint32_t what, std::uint64_t which, double low, double high) {
  return low +
         (high - low) * uniform_at({.seed = 17, .purpose = purpose_of("wide"), .who = what, .which = which});
}

std::vector<std::uint64_t> bits_of(const RayHit& hit) {
  const Vec3& n = hit.normal_ned;
  return {static_cast<std::uint64_t>(hit.status), std::bit_cast<std::uint64_t>(hit.range_m),
          std::bit_cast<std::uint64_t>(n.x()), std::bit_cast<std::uint64_t>(n.y()),
          std::bit_cast<std::uint64_t>(n.z())};
}

std::vector<VectorUnit> units_here() {
  std::vector<VectorUnit> units{VectorUnit::kSse2};
  for (const VectorUnit unit : {VectorUnit::kAvx2, VectorUnit::kAvx512}) {
    if (unit <= widest_vector_unit()) units.push_back(unit);
  }
  return units;
}

// How many of the rays had each status.
std::vector<int> expect_answers_of_single_rays(const Terrain& terrain, std::span<const Ray> rays) {
  std::vector<int> counts(6);
  std::vector<RayHit> single;
  for (const Ray& ray : rays) {
    single.push_back(terrain.closest_hit(ray));
    ++counts[static_cast<std::size_t>(single.back().status)];
  }
  for (const VectorUnit unit : units_here()) {
    const std::vector<RayHit> batch = terrain.closest_hits(rays, unit);
    EXPECT_EQ(batch.size(), rays.size());
    for (std::size_t n = 0; n < std::min(batch.size(), rays.size()); ++n) {
      EXPECT_EQ(bits_of(batch[n]), bits_of(single[n])) << "ray " << n << ", unit " << static_cast<int>(unit);
    }
  }
  return counts;
}

int count_of(const std::vector<int>& counts, RayStatus status) {
  return counts[static_cast<std::size_t>(status)];
}

// Rays of every inclination, from a little outside the terrain and from below its bottom, too; every fourth
// along a grid line, every fourth along a diagonal, every fourth from a post.
std::vector<Ray> rays_of_all_kinds(const Terrain& terrain, std::size_t count) {
  const GridGeometry& g = terrain.extent();
  const double length_x_m = g.last_x_m() - g.first_x_m, length_y_m = g.last_y_m() - g.first_y_m;
  std::vector<Ray> rays;
  for (std::uint64_t n = 0; n < count; ++n) {
    Vec3 from(g.first_x_m + draw(0, n, -0.02, 1.02) * length_x_m,
              g.first_y_m + draw(1, n, -0.02, 1.02) * length_y_m, 0);
    if (n % 4 != 0) {
      from.x() = g.x_at(static_cast<int>(std::lround((from.x() - g.first_x_m) / g.spacing_m)));
      from.y() = g.y_at(static_cast<int>(std::lround((from.y() - g.first_y_m) / g.spacing_m)));
    }
    const DepthSample bottom = terrain.depth_at(from.x(), from.y());
    from.z() = (bottom.status == DepthStatus::kOk ? bottom.z_m : 100) - draw(2, n, -2, 60);
    const double azimuth = n % 4 == 1 ? std::floor(draw(3, n, 0, 4)) * 1.5707963267948966
                           : n % 4 == 2
                               ? std::floor(draw(3, n, 0, 4)) * 1.5707963267948966 + 0.78539816339744831
                               : draw(3, n, -4, 4);
    const double down = n % 3 == 0   ? draw(4, n, 1.3, 1.5707963267948966)
                        : n % 3 == 1 ? draw(4, n, -0.1, 0.1)
                                     : draw(4, n, -1.5, 1.5);
    Vec3 direction(std::cos(azimuth) * std::cos(down), std::sin(azimuth) * std::cos(down), std::sin(down));
    if (n % 8 == 1) direction.x() = 0;
    if (n % 8 == 5) direction.y() = 0;
    if (n % 64 == 7) direction = -Vec3::UnitZ();
    rays.push_back({from, direction, draw(5, n, 0, 1) < 0.05 ? 0 : draw(5, n, 0, 2 * length_x_m)});
  }
  return rays;
}

TEST(RaysInBatches, HaveTheAnswersOfSingleRaysBitByBit) {
  const Terrain terrain(testing::rugged_grid(300));
  const std::vector<int> counts = expect_answers_of_single_rays(terrain, rays_of_all_kinds(terrain, 20'000));
  for (const RayStatus status :
       {RayStatus::kHit, RayStatus::kMiss, RayStatus::kOutside, RayStatus::kStartedBelowBottom})
    EXPECT_GT(count_of(counts, status), 200) << static_cast<int>(status);
}

TEST(RaysInBatches, EndAtHolesAsSingleRaysDo) {
  HeightGrid grid = testing::rugged_grid(130);
  for (std::uint64_t n = 0; n < 60; ++n) {
    const int i = static_cast<int>(draw(6, n, 0, 129.9)), j = static_cast<int>(draw(7, n, 0, 129.9));
    grid.posts_for_editing()[grid.index(i, j)] = kNoData;
  }
  const Terrain terrain(std::move(grid));
  const std::vector<int> counts = expect_answers_of_single_rays(terrain, rays_of_all_kinds(terrain, 10'000));
  EXPECT_GT(count_of(counts, RayStatus::kNoData), 200);
}

// Three grids side by side in the base, two of which share an edge, and one within one of them; two have
// holes.
Terrain nested_terrain() {
  HeightGrid with_hole = make_grid({500, 500, 10, 101, 101}, FlatShape{.depth_m = 60});
  for (int i = 10; i < 30; ++i) {
    for (int j = 60; j < 80; ++j) with_hole.posts_for_editing()[with_hole.index(i, j)] = kNoData;
  }
  HeightGrid innermost = make_grid({900, 900, 2, 101, 101}, FlatShape{.depth_m = 20});
  innermost.posts_for_editing()[innermost.index(30, 60)] = kNoData;
  std::vector<NestedGrid> nested;
  nested.push_back({std::move(with_hole), 100});
  nested.push_back({make_grid({1500, 500, 25, 11, 21}, FlatShape{.depth_m = 150}), 0});
  nested.push_back({std::move(innermost), 0});
  nested.push_back({make_grid({0, 1700, 50, 5, 5}, FlatShape{.depth_m = 250}), 50});
  return Terrain(testing::rugged_grid(41, 50), std::move(nested));
}

TEST(RaysInBatches, PassNestedGridsAsSingleRaysDo) {
  const Terrain terrain = nested_terrain();
  const std::vector<Ray> rays = rays_of_all_kinds(terrain, 10'000);
  const std::vector<int> counts = expect_answers_of_single_rays(terrain, rays);
  EXPECT_GT(count_of(counts, RayStatus::kHit), 1000);
  EXPECT_GT(count_of(counts, RayStatus::kNoData), 10);
}

TEST(RaysInBatches, HoldOnGridsOfAnyShape) {
  for (const auto& [posts_x, posts_y] : {std::pair{2, 2}, {3, 3}, {2, 300}, {257, 3}, {18, 33}}) {
    const HeightGrid rugged = testing::rugged_grid(300);
    HugePageVector<float> posts;
    for (int i = 0; i < posts_x; ++i) {
      for (int j = 0; j < posts_y; ++j) posts.push_back(rugged.post(i, j));
    }
    const Terrain terrain(HeightGrid({-70, 30, 10, posts_x, posts_y}, std::move(posts)));
    SCOPED_TRACE(std::to_string(posts_x) + " x " + std::to_string(posts_y));
    expect_answers_of_single_rays(terrain, rays_of_all_kinds(terrain, 2000));
  }
}

TEST(RaysInBatches, HoldForBatchesOfAnySize) {
  const Terrain terrain(testing::rugged_grid(129));
  const std::vector<Ray> rays = rays_of_all_kinds(terrain, 1100);
  for (const std::size_t size : {0, 1, 2, 7, 8, 9, 1023, 1024, 1025})
    expect_answers_of_single_rays(terrain, std::span(rays).first(size));
}

TEST(RaysInBatches, DependOnNoOrder) {
  const Terrain terrain = nested_terrain();
  std::vector<Ray> rays = rays_of_all_kinds(terrain, 3000);
  const std::vector<RayHit> forwards = terrain.closest_hits(rays);
  std::reverse(rays.begin(), rays.end());
  const std::vector<RayHit> backwards = terrain.closest_hits(rays);
  for (std::size_t n = 0; n < rays.size(); ++n)
    EXPECT_EQ(bits_of(forwards[n]), bits_of(backwards[rays.size() - 1 - n])) << n;
}

TEST(RaysInBatches, SayWhichRaysAreImpossible) {
  const Terrain terrain(testing::rugged_grid(33));
  const double inf = HUGE_VAL, nan = std::nan("");
  const std::vector<Ray> rays{{{nan, 0, 0}, {0, 0, 1}, 10},  {{0, inf, 0}, {0, 0, 1}, 10},
                              {{0, 0, 0}, {0, 0, 0}, 10},    {{0, 0, 0}, {0, nan, 1}, 10},
                              {{0, 0, 0}, {0, 0, 1}, -1},    {{0, 0, 0}, {0, 0, 1}, inf},
                              {{50, 50, 0}, {0, 0, 1}, 5000}};
  const std::vector<int> counts = expect_answers_of_single_rays(terrain, rays);
  EXPECT_EQ(count_of(counts, RayStatus::kBadInput), 6);
}

}  // namespace
}  // namespace halocline::bathymetry
