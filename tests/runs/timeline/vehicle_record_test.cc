// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/vehicle_record.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "runs/timeline/terrain_overview.h"
#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using testing::kSecond;
using testing::state;

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

Track track(std::initializer_list<vehicle_state_t> states) {
  Track made;
  for (const vehicle_state_t& s : states) made.add(SimTime::from_utime(s.utime), track_point_of(s));
  return made;
}

TEST(Track, BetweenTwoStatesItIsOnTheLineThroughThem) {
  const auto found = state_at(track({state(1, 0, 0, 10, 20), state(1, 4 * kSecond, 8, 10, 40)}), at(1));
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->point.position_ned_m.x(), 2);
  EXPECT_DOUBLE_EQ(found->point.position_ned_m.y(), 10);
  EXPECT_DOUBLE_EQ(found->point.position_ned_m.z(), 25);
  EXPECT_EQ(found->age, SimDuration());
}

TEST(Track, AfterTheLastStateItStaysThereAndAges) {
  const auto found = state_at(track({state(1, 0, 0), state(1, kSecond, 5)}), at(4));
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->point.position_ned_m.x(), 5);
  EXPECT_EQ(found->age, SimDuration::from_seconds(3));
}

TEST(Track, BeforeTheFirstStateItIsNowhere) {
  EXPECT_FALSE(state_at(track({state(1, kSecond, 5)}), at(0.5)));
  EXPECT_FALSE(state_at(Track(), at(0)));
}

TEST(Track, AnglesTurnTheShorterWay) {
  TrackPoint a, b;
  a.attitude.yaw = 3.0;
  b.attitude.yaw = -3.0;
  Track made;
  made.add(at(0), a);
  made.add(at(2), b);
  EXPECT_NEAR(std::abs(state_at(made, at(1))->point.attitude.yaw), std::numbers::pi, 1e-12);
}

TEST(Track, DecimationKeepsHowFarItWentNorthEastAndDeep) {
  Track made;
  for (int i = 0; i < 5000; ++i)
    made.add(at(i), track_point_of(state(1, i * kSecond, i == 1234 ? 900 : 0, i == 2345 ? -800 : 0,
                                         i == 3456 ? 700 : 0)));
  const auto points = decimated_track(made, at(0), at(5000), 200);
  EXPECT_LE(points.size(), 200u);
  Vec3 greatest = Vec3::Zero(), least = Vec3::Zero();
  for (const auto& point : points) {
    greatest = greatest.cwiseMax(point.value.position_ned_m);
    least = least.cwiseMin(point.value.position_ned_m);
  }
  EXPECT_EQ(greatest.x(), 900);
  EXPECT_EQ(least.y(), -800);
  EXPECT_EQ(greatest.z(), 700);
}

TEST(VehicleRecord, ItsWayIsTheSumOfItsSteps) {
  VehicleRecord vehicle;
  vehicle.track = track({state(1, 0, 0, 0), state(1, kSecond, 3, 4, 100), state(1, 2 * kSecond, 3, 0, 0)});
  EXPECT_DOUBLE_EQ(vehicle.distance_m(), 9);
  EXPECT_FALSE(vehicle.is_at_rest());
  vehicle.track = track({state(1, 0, 7), state(1, kSecond, 7)});
  EXPECT_TRUE(vehicle.is_at_rest());
}

TEST(TerrainOverview, IsLinearBetweenPostsAndEndsAtItsEdge) {
  TerrainOverview terrain{-10, -20, 10, 20, 2, 3, {100, 200, 300, 110, 210, 310}};
  EXPECT_DOUBLE_EQ(terrain.depth_at_m(-10, -20), 100);
  EXPECT_DOUBLE_EQ(terrain.depth_at_m(0, 20), 310);
  EXPECT_DOUBLE_EQ(terrain.depth_at_m(-5, -10), 155);
  EXPECT_TRUE(std::isnan(terrain.depth_at_m(0.1, 0)));
  EXPECT_TRUE(std::isnan(terrain.depth_at_m(-5, 20.1)));
  EXPECT_TRUE(std::isnan(TerrainOverview().depth_at_m(0, 0)));
}

TEST(TerrainOverview, BesideAPostWithoutTerrainThereIsNone) {
  TerrainOverview terrain{0, 0, 1, 1, 2, 2, {1, 2, 3, std::numeric_limits<float>::quiet_NaN()}};
  EXPECT_TRUE(std::isnan(terrain.depth_at_m(0.5, 0.5)));
  EXPECT_DOUBLE_EQ(terrain.depth_at_m(0, 0.5), 1.5);
}

}  // namespace
}  // namespace halocline::clients
