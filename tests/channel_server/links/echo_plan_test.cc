// SPDX-License-Identifier: BSD-3-Clause
// Which pairs are surveyed for their bottom echoes: those that moved, within an allowance, in turn.
#include "channel_server/links/echo_plan.h"

#include <map>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"

namespace halocline::channel_server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Vehicles 1, 2, ... on a line at these places, each with links to all others.
std::vector<EndPair> links_at(const std::vector<double>& norths_m) {
  std::vector<LinkEnd> ends;
  for (const double north_m : norths_m) {
    LinkEnd end;
    end.id = static_cast<VehicleId>(ends.size() + 1);
    end.position_ned_m = {north_m, 0, 50};
    ends.push_back(end);
  }
  std::vector<EndPair> links;
  for (const LinkEnd& from : ends) {
    for (const LinkEnd& to : ends) {
      if (from.id != to.id) links.push_back({from, to});
    }
  }
  return links;
}

std::vector<VehiclePair> pairs_of(const std::vector<PlannedSurvey>& surveys) {
  std::vector<VehiclePair> pairs;
  for (const PlannedSurvey& survey : surveys) pairs.push_back(survey.pair);
  return pairs;
}

TEST(EchoPlan, APairIsSurveyedOnceForBothWaysFromWhereItIs) {
  EchoPlan plan({.reuse_distance_m = 5});
  const auto surveys = plan.begin_tick(links_at({0, 100}));
  ASSERT_EQ(surveys.size(), 1u);
  EXPECT_EQ(surveys[0].pair, VehiclePair(1, 2));
  EXPECT_EQ(surveys[0].low_ned_m, Vec3(0, 0, 50));
  EXPECT_EQ(surveys[0].high_ned_m, Vec3(100, 0, 50));
}

TEST(EchoPlan, ASurveyServesUntilAnEndHasMovedFartherThanTheReuseDistance) {
  EchoPlan plan({.reuse_distance_m = 5});
  plan.begin_tick(links_at({0, 100}));
  EXPECT_THAT(plan.begin_tick(links_at({4.9, 104.9})), IsEmpty());
  EXPECT_THAT(pairs_of(plan.begin_tick(links_at({5.1, 100}))), ElementsAre(VehiclePair(1, 2)));
  EXPECT_THAT(plan.begin_tick(links_at({10, 100})), IsEmpty());
}

TEST(EchoPlan, WithoutReuseWhateverMovedIsSurveyed) {
  EchoPlan plan({.reuse_distance_m = 0});
  plan.begin_tick(links_at({0, 100}));
  EXPECT_THAT(plan.begin_tick(links_at({0, 100})), IsEmpty());
  EXPECT_EQ(plan.begin_tick(links_at({1e-9, 100})).size(), 1u);
}

TEST(EchoPlan, WithinItsAllowanceThosePlannedLongestAgoComeFirst) {
  EchoPlan plan({.reuse_distance_m = 5, .surveys_per_table = 2});
  EXPECT_THAT(pairs_of(plan.begin_tick(links_at({0, 100, 200}))),
              ElementsAre(VehiclePair(1, 2), VehiclePair(1, 3)));
  EXPECT_EQ(plan.deferred(), 1u);
  EXPECT_THAT(pairs_of(plan.begin_tick(links_at({10, 110, 210}))),
              ElementsAre(VehiclePair(2, 3), VehiclePair(1, 2)));
  EXPECT_THAT(pairs_of(plan.begin_tick(links_at({20, 120, 220}))),
              ElementsAre(VehiclePair(1, 3), VehiclePair(1, 2)));
  EXPECT_EQ(plan.deferred(), 1u);
}

// However many move at once each pair has its turn as often as any other.
TEST(EchoPlan, AFleetThatNeverRestsIsSurveyedInTurn) {
  EchoPlan plan({.reuse_distance_m = 5, .surveys_per_table = 7});
  std::vector<double> norths_m(15);
  std::map<VehiclePair, int> turns;
  for (int tick = 0; tick < 60; ++tick) {
    for (std::size_t i = 0; i < norths_m.size(); ++i)
      norths_m[i] = 100.0 * static_cast<double>(i) + 10 * tick;
    for (const VehiclePair& pair : pairs_of(plan.begin_tick(links_at(norths_m)))) ++turns[pair];
  }
  ASSERT_EQ(turns.size(), 105u);
  for (const auto& [pair, count] : turns) EXPECT_EQ(count, 4) << pair.first << ' ' << pair.second;
}

TEST(EchoPlan, WhatHadNoAnswerNeedsAnotherThoughNothingMoved) {
  EchoPlan plan({.reuse_distance_m = 5});
  plan.begin_tick(links_at({0, 100, 200}));
  plan.note_unanswered({1, 3});
  EXPECT_THAT(pairs_of(plan.begin_tick(links_at({0, 100, 200}))), ElementsAre(VehiclePair(1, 3)));
  plan.note_unanswered({7, 9});  // no such pair
  EXPECT_THAT(plan.begin_tick(links_at({0, 100, 200})), IsEmpty());
}

TEST(EchoPlan, APairWithoutALinkIsForgotten) {
  EchoPlan plan({.reuse_distance_m = 5});
  plan.begin_tick(links_at({0, 100}));
  plan.begin_tick(links_at({0}));
  EXPECT_EQ(plan.begin_tick(links_at({0, 100})).size(), 1u);
}

}  // namespace
}  // namespace halocline::channel_server
