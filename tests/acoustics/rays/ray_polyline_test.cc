// SPDX-License-Identifier: BSD-3-Clause
// The ways of paths: against images, arcs of circles, and the delays that the paths were found with.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

constexpr std::size_t kAll = 100'000;  // points: nothing is left out but for simplified()'s 0.05 m

RaySea sea_of(std::vector<SpeedRow> knots, BottomProfile bottom) {
  const RayWater water(std::move(knots), [](double) { return 1.0; });
  return {water, std::move(bottom), *sediment("MediumSand"), RaySurface{.wind_mps = 0},
          RayOptions{.frequency_hz = 10'000, .max_bounces = 20}};
}

std::vector<RayPoint> way_of(const RaySea& sea, const RayLink& link, const Eigenray& path,
                             std::size_t max_points = kAll) {
  return polyline({sea.water, sea.bottom_profile, sea.bottom, sea.surface, sea.options}, link, path,
                  max_points);
}

double length_m(const std::vector<RayPoint>& way) {
  double sum = 0;
  for (std::size_t i = 1; i < way.size(); ++i)
    sum += std::hypot(way[i].range_m - way[i - 1].range_m, way[i].depth_m - way[i - 1].depth_m);
  return sum;
}

// Travel time along straight pieces, by the middles of parts of half a metre.
double delay_s(const RayWater& water, const std::vector<RayPoint>& way) {
  double sum = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const RayPoint &a = way[i - 1], &b = way[i];
    const double length = std::hypot(b.range_m - a.range_m, b.depth_m - a.depth_m);
    const int parts = 1 + static_cast<int>(2 * length);
    for (int part = 0; part < parts; ++part)
      sum += length / parts / water.speed_at(a.depth_m + (b.depth_m - a.depth_m) * (part + 0.5) / parts);
  }
  return sum;
}

void expect_from_end_to_end(const std::vector<RayPoint>& way, const RayLink& link) {
  ASSERT_GE(way.size(), 2u);
  EXPECT_EQ(way.front().range_m, 0);
  EXPECT_NEAR(way.front().depth_m, link.source_depth_m, 1e-5);
  EXPECT_EQ(way.back().range_m, link.range_m);
  EXPECT_NEAR(way.back().depth_m, link.receiver_depth_m, 1e-5);
  for (std::size_t i = 1; i < way.size(); ++i) EXPECT_GE(way[i].range_m, way[i - 1].range_m);
}

TEST(RayPolyline, OfImagesIsStraightFromBounceToBounce) {
  const RaySea sea = sea_of({{0, 1500}, {12'000, 1500}}, BottomProfile::flat(100));
  const RayLink link{30, 60, 1000};
  const Eigenrays found = eigenrays(sea, link);
  ASSERT_EQ(found.solver, RaySolver::kImages);
  ASSERT_GT(found.paths.size(), 6u);
  for (const Eigenray& path : found.paths) {
    const auto way = way_of(sea, link, path);
    expect_from_end_to_end(way, link);
    EXPECT_EQ(way.size(), 2u + static_cast<std::size_t>(path.surface_bounces + path.bottom_bounces));
    // The image's distance; simplified() is exact here.
    EXPECT_NEAR(length_m(way), path.path_length_m, tolerance(1e-4));
    EXPECT_NEAR(length_m(way) / 1500, path.delay_s, tolerance(1e-7));
  }
  // The bounce at the surface: 30 of 90 m of the height on a third of the range.
  const auto once = std::find_if(found.paths.begin(), found.paths.end(), [](const Eigenray& path) {
    return path.surface_bounces == 1 && path.bottom_bounces == 0;
  });
  ASSERT_NE(once, found.paths.end());
  const auto way = way_of(sea, link, *once);
  EXPECT_NEAR(way[1].range_m, 1000.0 / 3, tolerance(1e-3));
  EXPECT_NEAR(way[1].depth_m, 0, tolerance(1e-5));
}

// In water of one gradient a ray is an arc of the circle of radius 1 / (xi g) about the depth where c would
// be 0.
TEST(RayPolyline, OfAConstantGradientLiesOnACircle) {
  constexpr double kGradient = 0.05, kSurfaceSpeed = 1480;
  const RaySea sea = sea_of({{0, kSurfaceSpeed},
                             {3000, kSurfaceSpeed + 3000 * kGradient},
                             {12'000, kSurfaceSpeed + 3000 * kGradient}},
                            BottomProfile::flat(2000));
  const RayLink link{400, 500, 6000};
  const Eigenrays found = eigenrays(sea, link);
  const auto direct = std::find_if(found.paths.begin(), found.paths.end(), [](const Eigenray& path) {
    return path.surface_bounces + path.bottom_bounces == 0;
  });
  ASSERT_NE(direct, found.paths.end());
  ASSERT_EQ(direct->identity.lower_turns, 1);
  const auto way = way_of(sea, link, *direct);
  expect_from_end_to_end(way, link);
  const double radius = 1 / (direct->launch_slowness_spm * kGradient), center_z = -kSurfaceSpeed / kGradient;
  const double center_r = radius * std::sin(direct->launch_angle_rad);
  EXPECT_GT(way.size(), 20u);
  for (const RayPoint& point : way)
    EXPECT_NEAR(std::hypot(point.range_m - center_r, point.depth_m - center_z), radius, tolerance(1e-3));
  // What lies between two points is off by the error stated, 0.1 m of the arcs and 0.05 m of simplified().
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double r = (way[i].range_m + way[i - 1].range_m) / 2, z = (way[i].depth_m + way[i - 1].depth_m) / 2;
    EXPECT_NEAR(std::hypot(r - center_r, z - center_z), radius, 0.16);
  }
}

// Any water over any bottom: the time along the drawn way is the delay of the path, which other code found.
// Rays that graze the surface have another range as waves: their way is drawn longer or shorter.
class RayWays : public ::testing::TestWithParam<bool> {};
TEST_P(RayWays, TakeAsLongAsTheirPaths) {
  const double share = GetParam() ? 1e-3 : 2e-5;
  std::vector<ProfiledDepth> ridge;
  for (double r = 0; r <= 5000; r += 50)
    ridge.push_back({r, 200 - 90 * std::exp(-std::pow((r - 2000) / 500, 2))});
  const std::vector<SpeedRow> summer{{0, 1520}, {20, 1519}, {40, 1490}, {120, 1488}, {12'000, 1600}};
  const struct {
    RaySea sea;
    RayLink link;
  } cases[] = {{sea_of(summer, BottomProfile(ridge)), {15, 100, 4000}},
               {sea_of(summer, BottomProfile(ridge)), {60, 30, 1500}},
               {sea_of(summer, BottomProfile::flat(150)), {60, 70, 8000}}};
  for (auto [sea, link] : cases) {
    sea.options.airy_folds = GetParam();
    const Eigenrays found = eigenrays(sea, link);
    ASSERT_FALSE(found.silent());
    for (const Eigenray& path : found.paths) {
      SCOPED_TRACE(std::to_string(path.launch_angle_rad));
      const auto way = way_of(sea, link, path);
      expect_from_end_to_end(way, link);
      EXPECT_NEAR(delay_s(sea.water, way), path.delay_s, share * path.delay_s);
      const auto touches = [&](auto&& is_there) {
        return std::count_if(way.begin() + 1, way.end() - 1, is_there);
      };
      EXPECT_EQ(touches([](const RayPoint& p) { return p.depth_m < 1e-3; }), path.surface_bounces);
      EXPECT_EQ(touches([&](const RayPoint& p) {
                  return p.depth_m > sea.bottom_profile.depth_at(p.range_m) - 1e-3;
                }),
                path.bottom_bounces);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutWaves, RayWays, ::testing::Bool());

TEST(RayPolyline, KeepsToItsPointsAndStaysNearTheWay) {
  const RaySea sea = sea_of({{0, 1500}, {50, 1490}, {12'000, 1600}}, BottomProfile::flat(60));
  const RayLink link{20, 40, 3000};
  const Eigenrays found = eigenrays(sea, link);
  for (const Eigenray& path : found.paths) {
    const auto whole = way_of(sea, link, path), few = way_of(sea, link, path, 16);
    expect_from_end_to_end(few, link);
    EXPECT_EQ(few.size(), std::min<std::size_t>(whole.size(), 16));
  }
}

TEST(RayPolyline, OfAVehicleRightAboveAnotherIsStraight) {
  const RaySea sea =
      sea_of({{0, 1500}, {50, 1490}, {12'000, 1600}}, BottomProfile({{0, 100}, {50, 99}, {100, 101}}));
  for (const RayLink& link : {RayLink{20, 80, 0}, RayLink{80, 20, 0.01}, RayLink{20.2, 20, 0}}) {
    const Eigenrays found = eigenrays(sea, link);
    ASSERT_FALSE(found.silent());
    for (const Eigenray& path : found.paths) {
      const auto way = way_of(sea, link, path);
      expect_from_end_to_end(way, held_apart(link));
      EXPECT_LE(way.size(), 3u + static_cast<std::size_t>(path.surface_bounces + path.bottom_bounces));
      EXPECT_NEAR(length_m(way), path.path_length_m, 1 + 0.01 * path.path_length_m);
    }
  }
}

// Both ends on the axis of a channel: the axial ray represents those of the core.
TEST(RayPolyline, OfTheCoreOfAChannelIsStraight) {
  const RaySea sea = sea_of({{0, 1520}, {100, 1500}, {200, 1520}, {12'000, 1700}}, BottomProfile::flat(300));
  const RayLink link{100, 100, 4000};
  const Eigenrays found = eigenrays(sea, link);
  ASSERT_FALSE(found.silent());
  for (const Eigenray& path : found.paths) expect_from_end_to_end(way_of(sea, link, path), link);
}

TEST(SimplifiedPolyline, KeepsThePointsThatChangeItMost) {
  const std::vector<RayPoint> points{{0, 0}, {1, 0.01}, {2, 5}, {3, 5.01}, {4, 40}, {5, 1}, {6, 0}};
  const auto ranges = [&](std::size_t max_points) {
    std::vector<double> kept;
    for (const RayPoint& point : simplified(points, max_points)) kept.push_back(point.range_m);
    return kept;
  };
  EXPECT_EQ(ranges(2), (std::vector<double>{0, 6}));
  EXPECT_EQ(ranges(3), (std::vector<double>{0, 4, 6}));
  EXPECT_EQ(ranges(5), (std::vector<double>{0, 3, 4, 5, 6}));
  EXPECT_EQ(ranges(100).size(), 7u);
  EXPECT_EQ(simplified({{0, 1}, {1, 1.01}, {2, 1}}, 9).size(), 2u);  // within 0.05 m
  EXPECT_EQ(simplified({{0, 1}}, 2).size(), 1u);
}

}  // namespace
}  // namespace halocline::acoustics
