// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/guidance.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

using std::numbers::pi;
const double kGuidanceRounding = tolerance(1e-12);  // a handful of operations on numbers of order 1

// A square of 100 m, 20 m deep, begun at its south-west corner.
Mission square(AtEnd at_end) {
  Mission mission;
  mission.waypoints = {{100, 0, 20}, {100, 100, 20}, {0, 100, 30}};
  mission.at_end = at_end;
  mission.acceptance_radius_m = 5;
  mission.lookahead_m = 15;
  return mission;
}

SetPoints points_at(const Mission& mission, const Vec3& position) {
  const Progress progress = advance(mission, begin(Vec3::Zero()), position);
  return set_points(mission, progress, position);
}

TEST(Guidance, OnTheLegTheCourseIsTheLegs) {
  EXPECT_NEAR(points_at(square(AtEnd::kHold), {50, 0, 0}).course_rad, 0, kGuidanceRounding);
}

TEST(Guidance, OffTheLegTheCourseLeadsBackByTheLookahead) {
  // 15 m to starboard with a lookahead of 15 m: 45 degrees to port.
  EXPECT_NEAR(points_at(square(AtEnd::kHold), {50, 15, 0}).course_rad, -pi / 4, kGuidanceRounding);
  EXPECT_NEAR(points_at(square(AtEnd::kHold), {50, -15, 0}).course_rad, pi / 4, kGuidanceRounding);
}

TEST(Guidance, FarOffTheLegTheCourseIsStraightTowardsIt) {
  EXPECT_NEAR(points_at(square(AtEnd::kHold), {50, 1e6, 0}).course_rad, -pi / 2, tolerance(2e-5));
}

TEST(Guidance, DepthAndSpeedAreTheMissions) {
  const SetPoints points = points_at(square(AtEnd::kHold), {50, 0, 0});
  EXPECT_EQ(points.z_ned_m, 20);
  EXPECT_EQ(points.speed_mps, 1.5);
  EXPECT_TRUE(points.propel);
}

TEST(Guidance, WaypointIsReachedWithinTheAcceptanceRadius) {
  const Mission mission = square(AtEnd::kHold);
  const Progress start = begin(Vec3::Zero());
  EXPECT_EQ(advance(mission, start, {94.9, 0, 0}).target, 0u);
  EXPECT_EQ(advance(mission, start, {95.1, 0, 0}).target, 1u);
}

TEST(Guidance, WaypointIsReachedWhenPassedAbeam) {
  const Mission mission = square(AtEnd::kHold);
  EXPECT_EQ(advance(mission, begin(Vec3::Zero()), {100.1, 40, 0}).target, 1u);
  EXPECT_EQ(advance(mission, begin(Vec3::Zero()), {99.9, 40, 0}).target, 0u);
}

TEST(Guidance, DepthDoesNotDecideWhetherAWaypointIsReached) {
  EXPECT_EQ(advance(square(AtEnd::kHold), begin(Vec3::Zero()), {100, 0, 500}).target, 1u);
}

TEST(Guidance, NextLegStartsAtTheWaypointNotAtTheVehicle) {
  const Mission mission = square(AtEnd::kHold);
  const Progress progress = advance(mission, begin(Vec3::Zero()), {98, 3, 20});
  EXPECT_EQ(progress.leg_start_ned_m, mission.waypoints[0]);
}

TEST(Guidance, LoopStartsAgainAtTheFirstWaypoint) {
  const Mission mission = square(AtEnd::kLoop);
  const Progress progress = advance(mission, {.target = 2, .leg_start_ned_m = {100, 100, 20}}, {0, 100, 30});
  EXPECT_EQ(progress.target, 0u);
  EXPECT_FALSE(progress.at_end);
}

TEST(Guidance, LoopWithinReachOfAllWaypointsEnds) {
  Mission mission;
  mission.waypoints = {{0, 0, 10}, {1, 0, 10}};
  mission.at_end = AtEnd::kLoop;
  EXPECT_LT(advance(mission, begin(Vec3::Zero()), Vec3::Zero()).target, 2u);
}

TEST(Guidance, StopEndsPropulsionAtTheLastWaypoint) {
  const Mission mission = square(AtEnd::kStop);
  const Progress progress = advance(mission, {.target = 2, .leg_start_ned_m = {100, 100, 20}}, {0, 100, 30});
  EXPECT_TRUE(progress.at_end);
  const SetPoints points = set_points(mission, progress, {0, 100, 30});
  EXPECT_FALSE(points.propel);
  EXPECT_EQ(points.speed_mps, 0);
}

TEST(Guidance, OnTheOrbitTheCourseIsTangentClockwise) {
  Mission mission = square(AtEnd::kHold);
  mission.hold_radius_m = 40;
  const Progress done{.target = 2, .leg_start_ned_m = {100, 100, 20}, .at_end = true};
  // North of the centre (0, 100), clockwise is east; east of it, south.
  EXPECT_NEAR(set_points(mission, done, {40, 100, 30}).course_rad, pi / 2, kGuidanceRounding);
  EXPECT_NEAR(set_points(mission, done, {0, 140, 30}).course_rad, pi, kGuidanceRounding);
}

TEST(Guidance, OutsideTheOrbitTheCourseLeadsInAndInsideOut) {
  Mission mission = square(AtEnd::kHold);
  mission.hold_radius_m = 40;
  const Progress done{.target = 2, .leg_start_ned_m = {100, 100, 20}, .at_end = true};
  const double outside = set_points(mission, done, {80, 100, 30}).course_rad;
  const double inside = set_points(mission, done, {20, 100, 30}).course_rad;
  EXPECT_LT(std::cos(outside), 0);  // south, towards the centre
  EXPECT_GT(std::cos(inside), 0);   // north, away from it
}

TEST(Guidance, CounterclockwiseCircleIsTheMirrorOfTheClockwise) {
  const Vec3 center(10, 20, 0);
  for (const double east : {25.0, 50.0, 70.0}) {
    const double there = course_on_circle(center, 30, true, {10, east, 0});
    const double back = course_on_circle(center, 30, false, {10, east, 0});
    EXPECT_NEAR(std::cos(there), -std::cos(back), kGuidanceRounding);  // along the circle: the other way
    EXPECT_NEAR(std::sin(there), std::sin(back), kGuidanceRounding);   // towards it: the same
  }
}

TEST(Guidance, AnglesAreWrappedToHalfATurn) {
  EXPECT_NEAR(wrapped(3 * pi / 2), -pi / 2, kGuidanceRounding);
  EXPECT_NEAR(wrapped(-3 * pi / 2), pi / 2, kGuidanceRounding);
  EXPECT_EQ(wrapped(-pi), pi);
}

TEST(Guidance, MissionWithoutWaypointsIsRefused) {
  EXPECT_THROW(advance(Mission{}, begin(Vec3::Zero()), Vec3::Zero()), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
