// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/strangers.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using ::testing::HasSubstr;
using testing::name_of;

constexpr double kTimeout_s = 5;

// So many that each further one needs a second state.
Strangers crowd() {
  Strangers strangers(for_s(kTimeout_s));
  for (VehicleId id = 1; id <= static_cast<VehicleId>(Strangers::kMaxAtOnce); ++id)
    EXPECT_EQ(strangers.admit(name_of(id), id, at_s(0)), "");
  return strangers;
}

TEST(Strangers, TheFirstAreFollowedFromTheirFirstState) {
  EXPECT_EQ(crowd().followed(), Strangers::kMaxAtOnce);
}

TEST(Strangers, OneMoreIsFollowedFromItsSecondState) {
  Strangers strangers = crowd();
  EXPECT_THAT(strangers.admit("more", 1000, at_s(0)), HasSubstr("second STATE"));
  EXPECT_EQ(strangers.admit("more", 1000, at_s(kTimeout_s)), "");
  EXPECT_EQ(strangers.followed(), Strangers::kMaxAtOnce + 1);
}

TEST(Strangers, OfTwoStatesEitherMayComeFirst) {
  Strangers strangers = crowd();
  EXPECT_NE(strangers.admit("more", 1000, at_s(1)), "");
  EXPECT_EQ(strangers.admit("more", 1000, at_s(0.9)), "");
}

TEST(Strangers, ARepetitionAnotherIdAndAStateLongAfterAreNoSecondState) {
  Strangers strangers = crowd();
  EXPECT_NE(strangers.admit("more", 1000, at_s(0)), "");
  EXPECT_NE(strangers.admit("more", 1000, at_s(0)), "");
  EXPECT_NE(strangers.admit("more", 1001, at_s(1)), "");
  EXPECT_NE(strangers.admit("more", 1001, at_s(1.1 + kTimeout_s)), "");
  EXPECT_EQ(strangers.admit("more", 1001, at_s(1.2 + kTimeout_s)), "");
}

TEST(Strangers, NamesWithoutEndKeepNoSteadyOneOut) {
  Strangers strangers = crowd();
  EXPECT_NE(strangers.admit("steady", 1000, at_s(0)), "");
  for (VehicleId id = 2000; id < 2000 + static_cast<VehicleId>(Strangers::kMaxCandidates) - 1; ++id)
    EXPECT_NE(strangers.admit(name_of(id), id, at_s(0)), "");
  EXPECT_EQ(strangers.admit("steady", 1000, at_s(1)), "");
}

TEST(Strangers, BeyondTheMostNobodyIsFollowedUntilOneLeaves) {
  Strangers strangers(for_s(kTimeout_s));
  for (VehicleId id = 1; id <= static_cast<VehicleId>(Strangers::kMaxFollowed); ++id) {
    if (!strangers.admit(name_of(id), id, at_s(0)).empty()) {
      EXPECT_EQ(strangers.admit(name_of(id), id, at_s(1)), "");
    }
  }
  EXPECT_THAT(strangers.admit("more", 1000, at_s(0)), HasSubstr("too many"));
  EXPECT_THAT(strangers.admit("more", 1000, at_s(1)), HasSubstr("too many"));
  strangers.leave();
  EXPECT_NE(strangers.admit("more", 1000, at_s(2)), "");
  EXPECT_EQ(strangers.admit("more", 1000, at_s(3)), "");
}

TEST(Strangers, AsManyAsTheScenarioSaysAreFollowed) {
  Strangers strangers(for_s(kTimeout_s), 1000);
  for (VehicleId id = 1; id <= 1000; ++id) {
    const bool at_once = strangers.admit(name_of(id), id, at_s(0)).empty();
    EXPECT_TRUE(at_once || strangers.admit(name_of(id), id, at_s(0.1)).empty()) << id;
  }
  EXPECT_THAT(strangers.admit("more", 2000, at_s(0)), HasSubstr("at most 1000"));
}

TEST(Strangers, AnotherRunKnowsNobody) {
  Strangers strangers = crowd();
  EXPECT_NE(strangers.admit("more", 1000, at_s(0)), "");
  strangers.clear();
  EXPECT_EQ(strangers.followed(), 0u);
  EXPECT_EQ(strangers.admit("more", 1000, at_s(1)), "");
}

}  // namespace
}  // namespace halocline::channel_server
