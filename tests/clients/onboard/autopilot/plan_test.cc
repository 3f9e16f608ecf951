// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/plan.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

using std::numbers::pi;
const double kPlanRounding = tolerance(1e-9);  // of coordinates of some 100 m

Behaviour heading(double heading_rad, double duration_s) {
  return {
      .kind = BehaviourKind::kHeading, .duration_s = duration_s, .depth_m = 12, .heading_rad = heading_rad};
}

Behaviour box(double heading_rad) {
  return {.kind = BehaviourKind::kSurvey,
          .depth_m = 40,
          .heading_rad = heading_rad,
          .center_north_m = 100,
          .center_east_m = -50,
          .length_m = 200,
          .width_m = 100,
          .track_spacing_m = 25,
          .turn_m = 30};
}

TEST(Survey, HasATrackForEachSpacingAcrossTheBox) { EXPECT_EQ(survey_points(box(0)).size(), 2u * 5u); }

TEST(Survey, TracksReachTheTurnBeyondTheBoxAtBothEnds) {
  const auto points = survey_points(box(0));
  EXPECT_NEAR(points[0].x(), 100 - 100 - 30, kPlanRounding);
  EXPECT_NEAR(points[1].x(), 100 + 100 + 30, kPlanRounding);
  EXPECT_NEAR(points[2].x(), 100 + 100 + 30, kPlanRounding);  // back again
}

TEST(Survey, TracksLieASpacingApartFromPortToStarboard) {
  const auto points = survey_points(box(0));
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(points[2 * i].y(), -100 + 25.0 * static_cast<double>(i), kPlanRounding);
    EXPECT_NEAR(points[2 * i + 1].y(), points[2 * i].y(), kPlanRounding);
  }
}

TEST(Survey, WhatTheSpacingLeavesIsSharedByBothSides) {
  Behaviour survey = box(0);
  survey.width_m = 110;  // 10 m more than four spacings
  const auto points = survey_points(survey);
  EXPECT_NEAR(points.front().y() - (-50 - 55), (-50 + 55) - points.back().y(), kPlanRounding);
}

TEST(Survey, TurnsWithItsHeading) {
  const auto north = survey_points(box(0)), turned = survey_points(box(pi / 3));
  const Vec3 center(100, -50, 0);
  const Eigen::AngleAxisd turn(pi / 3, Vec3::UnitZ());
  for (std::size_t i = 0; i < north.size(); ++i) {
    EXPECT_NEAR((turned[i] - center - turn * (north[i] - center)).norm(), 0, kPlanRounding);
  }
}

TEST(Survey, BoxWithoutWidthIsOneTrack) {
  Behaviour survey = box(0);
  survey.width_m = 0;
  EXPECT_EQ(survey_points(survey).size(), 2u);
}

TEST(Plan, WaypointsAloneAreSteeredAsTheyAlwaysWere) {
  Mission mission;
  mission.waypoints = {{100, 0, 20}, {100, 100, 25}};
  const Plan plan = make_plan(mission, {});
  const Vec3 start(3, 4, 5), on_the_way(50, 7, 15);
  const PlanProgress progress = advance(plan, begin(start, 0), on_the_way, 10);
  const SetPoints expected = set_points(mission, begin(start), on_the_way);
  const SetPoints points = set_points(plan, progress, on_the_way);
  EXPECT_EQ(points.course_rad, expected.course_rad);
  EXPECT_EQ(points.z_ned_m, expected.z_ned_m);
  EXPECT_EQ(points.altitude_m, 0);
}

TEST(Plan, BehavioursFollowOneAnother) {
  Mission mission;
  mission.speed_mps = 1.2;
  Behaviour route{.waypoints = {{0, 200, 30}}, .speed_mps = 2};
  const Plan plan = make_plan(mission, {heading(0.5, 60), route});
  const Vec3 somewhere(10, 10, 10);
  PlanProgress progress = advance(plan, begin(Vec3::Zero(), 0), somewhere, 59.9);
  EXPECT_EQ(progress.index, 0u);
  EXPECT_EQ(set_points(plan, progress, somewhere).course_rad, 0.5);
  EXPECT_EQ(set_points(plan, progress, somewhere).z_ned_m, 12);
  EXPECT_EQ(set_points(plan, progress, somewhere).speed_mps, 1.2);
  progress = advance(plan, progress, somewhere, 60);
  EXPECT_EQ(progress.index, 1u);
  EXPECT_EQ(progress.route.leg_start_ned_m, somewhere);
  EXPECT_EQ(set_points(plan, progress, somewhere).z_ned_m, 30);
  EXPECT_EQ(set_points(plan, progress, somewhere).speed_mps, 2);
}

TEST(Plan, WithoutADurationAHeadingIsKeptForEver) {
  const Plan plan = make_plan({}, {heading(0.5, 0)});
  EXPECT_FALSE(advance(plan, begin(Vec3::Zero(), 0), Vec3::Zero(), 1e7).ended);
}

TEST(Plan, StopEndsPropulsionAfterTheLastBehaviour) {
  Mission mission;
  mission.at_end = AtEnd::kStop;
  const Plan plan = make_plan(mission, {heading(0.5, 60)});
  const PlanProgress progress = advance(plan, begin(Vec3::Zero(), 0), Vec3::Zero(), 61);
  EXPECT_TRUE(progress.ended);
  EXPECT_FALSE(set_points(plan, progress, Vec3::Zero()).propel);
}

TEST(Plan, HoldCirclesWhereTheLastBehaviourEnded) {
  Mission mission;
  mission.hold_radius_m = 40;
  const Plan plan = make_plan(mission, {heading(0.5, 60)});
  const Vec3 end(70, 0, 12);
  const PlanProgress progress = advance(plan, begin(Vec3::Zero(), 0), end, 61);
  const SetPoints points = set_points(plan, progress, end + Vec3(40, 0, 0));
  EXPECT_NEAR(points.course_rad, pi / 2, kPlanRounding);  // north of it, clockwise
  EXPECT_EQ(points.z_ned_m, 12);
}

TEST(Plan, LoopBeginsAgainWithTheFirstBehaviour) {
  Mission mission;
  mission.at_end = AtEnd::kLoop;
  const Plan plan = make_plan(mission, {heading(0, 60), heading(1, 60)});
  PlanProgress progress = advance(plan, begin(Vec3::Zero(), 0), Vec3::Zero(), 60);
  EXPECT_EQ(progress.index, 1u);
  progress = advance(plan, progress, Vec3::Zero(), 120);
  EXPECT_EQ(progress.index, 0u);
  EXPECT_EQ(progress.since_s, 120);
}

TEST(Plan, LoiterCirclesInItsSense) {
  Behaviour loiter{.kind = BehaviourKind::kLoiter, .depth_m = 20, .center_east_m = 100, .radius_m = 30};
  loiter.sense = Sense::kCounterclockwise;
  const Plan plan = make_plan({}, {loiter});
  const Vec3 north_of_it(30, 100, 20);
  EXPECT_NEAR(set_points(plan, begin(north_of_it, 0), north_of_it).course_rad, -pi / 2, kPlanRounding);
}

TEST(Plan, AltitudeOfABehaviourReachesItsSetPoints) {
  Behaviour survey = box(0);
  survey.altitude_m = 5;
  survey.max_depth_m = 300;
  const SetPoints points = set_points(make_plan({}, {survey}), begin(Vec3::Zero(), 0), Vec3::Zero());
  EXPECT_EQ(points.altitude_m, 5);
  EXPECT_EQ(points.max_z_ned_m, 300);
}

TEST(Plan, NothingToDoIsRefused) { EXPECT_THROW(make_plan({}, {}), InvalidArgument); }

TEST(Plan, WaitingStopsForItsDurationAndThenComesUp) {
  const Plan plan = make_plan({.waypoints = {}, .at_end = AtEnd::kSurface},
                              {{.kind = BehaviourKind::kWait, .duration_s = 60}});
  const Vec3 here(1, 2, 30);
  PlanProgress progress = advance(plan, begin(here, 0), here, 59);
  SetPoints points = set_points(plan, progress, here);
  EXPECT_FALSE(points.propel);
  EXPECT_FALSE(points.surface);
  EXPECT_EQ(points.z_ned_m, 30);
  progress = advance(plan, progress, here, 60);
  points = set_points(plan, progress, here);
  EXPECT_TRUE(progress.ended);
  EXPECT_FALSE(points.propel);
  EXPECT_TRUE(points.surface);
}

TEST(Plan, ARouteMayEndAtTheSurface) {
  const Plan plan = make_plan({.waypoints = {{0, 0, 30}}, .at_end = AtEnd::kSurface}, {});
  const Vec3 there(0, 0, 30);
  const SetPoints points = set_points(plan, advance(plan, begin(there, 0), there, 1), there);
  EXPECT_FALSE(points.propel);
  EXPECT_TRUE(points.surface);
}

}  // namespace
}  // namespace halocline::clients
