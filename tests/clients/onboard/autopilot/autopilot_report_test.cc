// SPDX-License-Identifier: BSD-3-Clause
// PLAN and AUTOPILOT: the plan, how far it has come, what the autopilot does and why.
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/messages/message_checks.h"
#include "clients/onboard/autopilot/autopilot_messages.h"
#include "clients/onboard/autopilot/plan.h"
#include "tests/clients/onboard/autopilot/autopilot_node_fixture.h"

namespace halocline::clients {
namespace {

TEST_F(AutopilotNodeTest, ThePlanIsPublishedAtTheStartAlsoBeforeThereIsAState) {
  step(0);
  ASSERT_EQ(plans_.size(), 1u);
  EXPECT_EQ(plans_[0].utime, 0);
  EXPECT_EQ(plans_[0].session, 11);
  EXPECT_EQ(plans_[0].at_end, vehicle_plan_t::HOLD);
  ASSERT_EQ(plans_[0].num_behaviours, 1);
  EXPECT_EQ(plans_[0].behaviours[0].behaviour_kind, plan_behaviour_t::WAYPOINTS);
  ASSERT_EQ(plans_[0].num_waypoints, 1);
  EXPECT_EQ(plans_[0].waypoint_ned_m[0], (std::vector<double>{0, 500, 20}));
  ASSERT_EQ(reports_.size(), 1u);
  EXPECT_EQ(reports_[0].autopilot_activity, autopilot_status_t::WAITING_FOR_STATE);
  EXPECT_FALSE(reports_[0].is_propelled);
}

TEST_F(AutopilotNodeTest, WhatItDoesIsPublishedOnceASecondAndAtEachChange) {
  for (int ms = 0; ms <= 5000; ms += 100) {
    if (ms >= 1500 && ms <= 2500) publish_state(ms);
    step(ms);
  }
  std::vector<std::pair<std::int64_t, int>> seen;
  for (const auto& report : reports_) seen.emplace_back(report.utime / 1000, report.autopilot_activity);
  constexpr int kWaiting = autopilot_status_t::WAITING_FOR_STATE, kLeg = autopilot_status_t::FOLLOWING_LEG,
                kLost = autopilot_status_t::LOST_STATE;
  const std::vector<std::pair<std::int64_t, int>> expected{{0, kWaiting}, {1000, kWaiting}, {1500, kLeg},
                                                           {2000, kLeg},  {3000, kLeg},     {3600, kLost},
                                                           {4000, kLost}, {5000, kLost}};
  EXPECT_EQ(seen, expected);
  EXPECT_EQ(reports_[2].commanded_z_m, 20);
  EXPECT_EQ(reports_[2].commanded_speed_mps, 1.5);
  EXPECT_NEAR(reports_[2].commanded_course_rad, 1.5707963, 1e-6);  // east
  EXPECT_TRUE(reports_[2].is_propelled);
  EXPECT_EQ(plans_.size(), 1u);
}

TEST_F(AutopilotNodeTest, ThePlanComesAgainAtItsEndAndEachMinute) {
  for (int ms = 0; ms <= 121'000; ms += 100) {
    publish_state(ms, ms < 30'050 ? 0 : 499);
    step(ms);
  }
  std::vector<std::pair<std::int64_t, bool>> seen;
  for (const auto& plan : plans_) seen.emplace_back(plan.utime / 1000, plan.plan_ended);
  const std::vector<std::pair<std::int64_t, bool>> expected{
      {0, false}, {30'100, true}, {60'000, true}, {120'000, true}};
  EXPECT_EQ(seen, expected);
  EXPECT_EQ(reports_.back().autopilot_activity, autopilot_status_t::HOLDING);
}

TEST_F(AutopilotNodeTest, TheSeabedIsNamedWhereItRulesTheDepth) {
  publish_state(0);
  publish_sensors(0, 1.5, 10);  // the plan is 20 m deep, the seabed 10 m
  step(0);
  ASSERT_EQ(reports_.size(), 1u);
  EXPECT_EQ(reports_[0].depth_rule, autopilot_status_t::DEPTH_AVOIDING_SEABED);
  EXPECT_NEAR(reports_[0].commanded_z_m, 10 - 3, 1e-9);
}

TEST_F(AutopilotNodeTest, AnotherRunGetsThePlanAnew) {
  step(0);
  node_.restart({at_ms(0), at_ms(0)});
  step(0);
  EXPECT_EQ(plans_.size(), 2u);
  EXPECT_EQ(reports_.size(), 2u);
}

TEST(PlanMessage, HasTheWaypointsOfEveryBehaviourAndCountsWhatDoesNotFit) {
  PilotConfig config;
  std::vector<Behaviour> behaviours{
      {.kind = BehaviourKind::kHeading, .duration_s = 60, .heading_rad = 6},
      {.kind = BehaviourKind::kSurvey, .width_m = 40'000, .track_spacing_m = 20}};
  behaviours.resize(150, {.kind = BehaviourKind::kWaypoints, .waypoints = {{1, 2, 3}, {4, 5, 6}}});
  const Plan plan = make_plan(config.mission, behaviours);
  const vehicle_plan_t message = to_message(plan, {.index = 1, .route = {.target = 7}}, config);
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.behaviour_index, 1);
  EXPECT_EQ(message.waypoint_index, 7);
  EXPECT_EQ(message.num_behaviours, 100);
  EXPECT_EQ(message.behaviours_left_out, 50);
  EXPECT_EQ(message.num_waypoints, 1200);
  EXPECT_EQ(message.waypoints_left_out, 2 * 2001 + 2 * 148 - 1200);
  EXPECT_EQ(message.waypoint_behaviour[0], 1);
  EXPECT_EQ(message.waypoint_ned_m[3][0], plan.routes[1].waypoints[3].x());
  EXPECT_NEAR(message.behaviours[0].heading_rad, 6 - 6.283185307, 1e-9);
  EXPECT_LT(message.getEncodedSize(), 60'000);
}

}  // namespace
}  // namespace halocline::clients
