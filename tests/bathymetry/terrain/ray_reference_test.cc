// SPDX-License-Identifier: BSD-3-Clause
// Rays against the long double reference at every cell crossing: no miss, no false hit, ranges to 1e-6 m.
// HALOCLINE_REFERENCE_RAYS sets how many random rays of each kind (default 3000; 500 000 takes minutes).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "bathymetry/terrain/terrain.h"
#include "core/frames.h"
#include "core/random.h"
#include "tests/bathymetry/terrain/reference_trace.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;
using testing::reference_trace;

constexpr int kPosts = 513;
constexpr double kExtentM = 5120;

const Terrain& rugged_terrain() {
  static const Terrain terrain(testing::rugged_grid(kPosts));
  return terrain;
}

std::uint64_t ray_count() {
  const char* text = std::getenv("HALOCLINE_REFERENCE_RAYS");
  return text != nullptr ? std::stoull(text) : 3000;
}

double draw(std::uint32_t what, std::uint64_t which, double low, double high) {
  return low +
         (high - low) * uniform_at({.seed = 11, .purpose = purpose_of("ray"), .who = what, .which = which});
}

Vec3 direction_of(double azimuth, double elevation) {  // elevation: above 0 is down
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

// A point of the water over the terrain, `low`..`high` metres above the bottom.
Vec3 water_point(std::uint64_t n, double low, double high) {
  const double x = draw(0, n, 0, kExtentM), y = draw(1, n, 0, kExtentM);
  return {x, y, rugged_terrain().depth_at(x, y).z_m - draw(2, n, low, high)};
}

struct Score {
  int rays = 0, hits = 0, missed = 0, false_hits = 0, touching = 0;
  double max_error_m = 0;
};

bool agree(const RayHit& actual, const testing::ReferenceHit& expected) {
  if ((actual.status == RayStatus::kHit) != expected.hit) return false;
  return !expected.hit || std::abs(static_cast<double>(actual.range_m - expected.range_m)) < 1e-3;
}

// A ray that touches the bottom and goes on may be decided either way: its own coordinates round by more. It
// counts as such when moving it by 1e-9 m up or down makes the reference agree with the rays.
bool only_touches(const Ray& ray, const RayHit& actual) {
  for (const double shift : {-1e-9, 1e-9}) {
    Ray moved = ray;
    moved.origin_ned_m.z() += shift;
    if (agree(actual, reference_trace(rugged_terrain().grid(0), moved))) return true;
  }
  return false;
}

void compare(const Ray& ray, Score& score) {
  const auto expected = reference_trace(rugged_terrain().grid(0), ray);
  const RayHit actual = rugged_terrain().closest_hit(ray);
  ++score.rays;
  score.hits += expected.hit;
  if (!agree(actual, expected)) {
    if (only_touches(ray, actual)) {
      ++score.touching;
    } else {
      ++(expected.hit ? score.missed : score.false_hits);
    }
  } else if (expected.hit) {
    // Along a tangent the range is ill-conditioned; there the distance between ray and bottom is the measure.
    const double error = std::abs(static_cast<double>(actual.range_m - expected.range_m));
    const double conditioning = std::min(1.0, static_cast<double>(expected.approach) * 1e3);
    score.max_error_m = std::max(score.max_error_m, error * conditioning);
  }
}

void expect_exact(const Score& score) {
  EXPECT_EQ(score.missed, 0);
  EXPECT_EQ(score.false_hits, 0);
  EXPECT_LT(score.max_error_m, tolerance(1e-6));
  EXPECT_GT(score.hits, score.rays / 20) << "the rays must meet the bottom for the test to show something";
  // Aimed rays touch where their target is a summit, about one in a hundred.
  EXPECT_LE(score.touching, score.rays / 40);
  std::printf("%d rays, %d hits, %d only touching, greatest error %.2g m\n", score.rays, score.hits,
              score.touching, score.max_error_m);
}

TEST(RayAgainstReference, NearVerticalRaysAreExact) {
  Score score;
  for (std::uint64_t n = 0; n < ray_count(); ++n) {
    compare({water_point(n, 0, 250), direction_of(draw(3, n, -4, 4), draw(4, n, 1.4, 1.5708)), 500}, score);
  }
  expect_exact(score);
}

TEST(RayAgainstReference, SlantedRaysAreExact) {
  Score score;
  for (std::uint64_t n = 0; n < ray_count(); ++n) {
    compare({water_point(n, 0, 250), direction_of(draw(3, n, -4, 4), draw(4, n, 0.6, 1)), 10'000}, score);
  }
  expect_exact(score);
}

TEST(RayAgainstReference, GrazingRaysAreExact) {
  Score score;
  for (std::uint64_t n = 0; n < ray_count(); ++n) {
    compare({water_point(n, 0, 250), direction_of(draw(3, n, -4, 4), draw(4, n, -0.03, 0.06)), 20'000},
            score);
  }
  expect_exact(score);
}

// The points that leak in other implementations: posts, middles of edges and of cells.
Vec3 aimed_target(std::uint64_t n) {
  const double offset_x = n % 3 == 1 ? 5 : 0, offset_y = n % 3 == 2 ? 5 : (n % 12 == 0 ? 5 : 0);
  const double x = 10 * std::floor(draw(5, n, 10, 500)) + offset_x,
               y = 10 * std::floor(draw(6, n, 10, 500)) + offset_y;
  return {x, y, rugged_terrain().depth_at(x, y).z_m};
}

void compare_aimed(const Vec3& from, const Vec3& at, Score& score) {
  const DepthSample start = rugged_terrain().depth_at(from.x(), from.y());
  if (start.status != DepthStatus::kOk || from.z() >= start.z_m || from == at) return;
  compare({from, (at - from).normalized(), 20'000}, score);
}

TEST(RayAgainstReference, RaysAimedAtPostsEdgesAndMiddlesAreExact) {
  Score score;
  for (std::uint64_t n = 0; n < ray_count(); ++n)
    compare_aimed(water_point(n, 0.1, 250), aimed_target(n), score);
  expect_exact(score);
}

TEST(RayAgainstReference, VerticalRaysOntoPostsAndEdgesAreExact) {
  Score score;
  for (std::uint64_t n = 0; n < ray_count(); ++n) {
    const Vec3 at = aimed_target(n);
    compare_aimed({at.x(), at.y(), at.z() - draw(7, n, 0.001, 300)}, at, score);
  }
  EXPECT_EQ(score.hits, score.rays);
  expect_exact(score);
}

TEST(RayAgainstReference, RaysAlongEdgesAndDiagonalsAreExact) {
  Score score;
  for (std::uint64_t n = 0; n < ray_count(); ++n) {
    const Vec3 at = aimed_target(n);
    const double steps = 10 * std::floor(draw(8, n, 1, 60));
    const double north = n % 4 == 1 ? 0 : steps, east = n % 4 == 0 ? 0 : (n % 4 == 3 ? -steps : steps);
    const Vec3 from(at.x() - north, at.y() - east, at.z() - draw(7, n, 0, 200));
    compare_aimed(from, at, score);
  }
  expect_exact(score);
}

TEST(RayAgainstReference, RaysThatSkimAPostByAMillimetreAreDecidedRight) {
  Score score;
  for (std::uint64_t n = 0; n < ray_count(); ++n) {
    const Vec3 post = aimed_target(n) + Vec3(0, 0, n % 2 == 0 ? 1e-3 : -1e-3);
    const Vec3 from = post - 200 * direction_of(draw(3, n, -4, 4), draw(4, n, -0.2, 0.2));
    compare_aimed(from, post, score);
  }
  expect_exact(score);
}

}  // namespace
}  // namespace halocline::bathymetry
