#include "channel_server/propagation/seabed_profile_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/propagation/terrain_rays.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class SeabedProfileCacheTest : public ::testing::Test {
 protected:
  PlacedVehicle vehicle(VehicleId id, double north_m) const {
    PlacedVehicle placed;
    placed.id = id;
    placed.placement.position_ned_m = {north_m, 0, 50};
    return placed;
  }
  // A tick at `time_s` of vehicle 1 at the origin and vehicle 2 at `north_m`; the service answers when `there`,
  // with a flat bottom as deep as the second cell's number.
  std::vector<VehiclePair> tick(double time_s, double north_m, bool there = true) {
    profiles_.open_tick(at_s(time_s));
    const auto wanted = profiles_.take_geometry({vehicle(1, 0), vehicle(2, north_m)});
    for (const VehiclePair& pair : wanted) {
      if (there) store(pair);
    }
    return wanted;
  }
  void store(const VehiclePair& pair) { profiles_.store(pair, answered(profiles_.survey_of(pair))); }
  static ProfileSurvey answered(ProfileSurvey survey) {
    const double depth = static_cast<double>(survey.cells().to.north);
    survey.take(std::vector<RayAnswer>(survey.rays().size(), {RayAnswer::Kind::kHit, depth}));
    return survey;
  }
  // Depth of the profile that holds at `time_s`; 0 when the bottom is unknown.
  double depth(double time_s) const {
    const auto profile = profiles_.at(at_s(time_s), kPair);
    return profile ? profile->front() : 0;
  }

  static constexpr VehiclePair kPair{1, 2};
  SeabedProfileCache profiles_{ProfileRule{}};
};

TEST_F(SeabedProfileCacheTest, WhatIsQueriedAtATickServesFromTheNextTickOn) {
  tick(1, 1000);
  EXPECT_EQ(depth(1.999), 0);
  tick(2, 1000);
  EXPECT_EQ(depth(1.999), 0);
  EXPECT_EQ(depth(2), 100);
  EXPECT_EQ(depth(2.5), 100);
}

TEST_F(SeabedProfileCacheTest, AProfileIsKeptAsLongAsBothEndsStayInTheirCells) {
  EXPECT_THAT(tick(1, 1000), ElementsAre(kPair));
  EXPECT_THAT(tick(2, 1004.9), IsEmpty());
  EXPECT_THAT(tick(3, 1005.1), ElementsAre(kPair));
}

TEST_F(SeabedProfileCacheTest, AVehicleThatChangesCellsHasTheProfileOfTheCellsOneTickAgo) {
  for (int second = 1; second <= 6; ++second) tick(second, 1000 + 10 * second);
  for (int second = 2; second <= 6; ++second) EXPECT_EQ(depth(second), 100 + second - 1) << second;
}

TEST_F(SeabedProfileCacheTest, SoundOnItsWayKeepsTheProfileOfItsDeparture) {
  for (int second = 1; second <= 20; ++second) tick(second, 1000 + 10 * second);
  EXPECT_EQ(depth(5.5), 104);
}

TEST_F(SeabedProfileCacheTest, WithoutAnAnswerInTimeTheBottomIsUnknownUntilItCame) {
  tick(1, 1000);
  tick(2, 1000);
  tick(3, 1010, false);
  EXPECT_EQ(depth(3), 100);  // the cells of tick 2
  tick(4, 1010, false);
  EXPECT_EQ(depth(4), 0);
  tick(5, 1010);
  EXPECT_EQ(depth(5), 0);
  tick(6, 1010);
  EXPECT_EQ(depth(6), 101);
  EXPECT_EQ(depth(3), 100);
}

TEST_F(SeabedProfileCacheTest, AnAnswerAfterTheTickServesFromTheTickAfter) {
  tick(1, 1000, false);
  tick(2, 1000, false);
  store(kPair);
  EXPECT_EQ(depth(2.5), 0);
  tick(3, 1000);
  EXPECT_EQ(depth(3), 100);
}

TEST_F(SeabedProfileCacheTest, AnAnswerForCellsThatWereLeftIsOfNoUse) {
  tick(1, 1000, false);
  const ProfileSurvey old = answered(profiles_.survey_of(kPair));
  tick(2, 1010, false);
  profiles_.store(kPair, old);
  tick(3, 1010, false);
  EXPECT_EQ(depth(3), 0);
}

TEST_F(SeabedProfileCacheTest, CellsThatTheTerrainDoesNotReachAreNotQueriedAgain) {
  profiles_.open_tick(at_s(1));
  profiles_.take_geometry({vehicle(1, 0), vehicle(2, 1000)});
  ProfileSurvey survey = profiles_.survey_of(kPair);
  survey.take(std::vector<RayAnswer>(survey.rays().size(), {RayAnswer::Kind::kOutside, 0}));
  profiles_.store(kPair, survey);
  EXPECT_THAT(tick(2, 1000), IsEmpty());
  EXPECT_EQ(depth(2), 0);
}

TEST_F(SeabedProfileCacheTest, AVehicleThatLeftHasNoBottomAndOneThatReturnsIsQueriedAnew) {
  tick(1, 1000);
  tick(2, 1000);
  profiles_.open_tick(at_s(3));
  profiles_.take_geometry({vehicle(1, 0)});
  profiles_.open_tick(at_s(4));
  EXPECT_EQ(depth(3), 100);
  EXPECT_EQ(depth(4), 0);
  profiles_.forget_before(at_s(10));
  EXPECT_EQ(depth(3), 0);
  EXPECT_THAT(tick(11, 1000), ElementsAre(kPair));
}

TEST_F(SeabedProfileCacheTest, ForgettingKeepsWhatLaterInstantsNeed) {
  for (int second = 1; second <= 9; ++second) tick(second, 1000 + 10 * second);
  profiles_.forget_before(at_s(5.5));
  EXPECT_EQ(depth(4.5), 0);
  for (int second = 6; second <= 9; ++second) EXPECT_EQ(depth(second), 100 + second - 1) << second;
  EXPECT_EQ(depth(5.5), 104);
}

TEST_F(SeabedProfileCacheTest, ThePairsQueriedLongestAgoComeFirst) {
  const std::vector<PlacedVehicle> fleet{vehicle(1, 0), vehicle(2, 100), vehicle(3, 200)};
  profiles_.open_tick(at_s(1));
  profiles_.take_geometry(fleet);
  profiles_.note_queried({1, 2});
  profiles_.open_tick(at_s(2));
  EXPECT_THAT(profiles_.take_geometry(fleet), ElementsAre(VehiclePair(1, 3), VehiclePair(2, 3), kPair));
}

}  // namespace
}  // namespace halocline::channel_server
