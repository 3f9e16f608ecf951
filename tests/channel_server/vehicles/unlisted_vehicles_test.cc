// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/unlisted_vehicles.h"

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
UnlistedVehicles crowd() {
  UnlistedVehicles unlisted(for_s(kTimeout_s));
  for (VehicleId id = 1; id <= static_cast<VehicleId>(UnlistedVehicles::kMaxAtOnce); ++id)
    EXPECT_EQ(unlisted.admit(name_of(id), id, at_s(0)), "");
  return unlisted;
}

TEST(UnlistedVehicles, TheFirstAreTrackedFromTheirFirstState) { crowd(); }

TEST(UnlistedVehicles, OneMoreIsTrackedFromItsSecondState) {
  UnlistedVehicles unlisted = crowd();
  EXPECT_THAT(unlisted.admit("more", 1000, at_s(0)), HasSubstr("second STATE"));
  EXPECT_EQ(unlisted.admit("more", 1000, at_s(kTimeout_s)), "");
}

TEST(UnlistedVehicles, OfTwoStatesEitherMayComeFirst) {
  UnlistedVehicles unlisted = crowd();
  EXPECT_NE(unlisted.admit("more", 1000, at_s(1)), "");
  EXPECT_EQ(unlisted.admit("more", 1000, at_s(0.9)), "");
}

TEST(UnlistedVehicles, ARepetitionAnotherIdAndAStateLongAfterAreNoSecondState) {
  UnlistedVehicles unlisted = crowd();
  EXPECT_NE(unlisted.admit("more", 1000, at_s(0)), "");
  EXPECT_NE(unlisted.admit("more", 1000, at_s(0)), "");
  EXPECT_NE(unlisted.admit("more", 1001, at_s(1)), "");
  EXPECT_NE(unlisted.admit("more", 1001, at_s(1.1 + kTimeout_s)), "");
  EXPECT_EQ(unlisted.admit("more", 1001, at_s(1.2 + kTimeout_s)), "");
}

TEST(UnlistedVehicles, NamesWithoutEndKeepNoSteadyOneOut) {
  UnlistedVehicles unlisted = crowd();
  EXPECT_NE(unlisted.admit("steady", 1000, at_s(0)), "");
  for (VehicleId id = 2000; id < 2000 + static_cast<VehicleId>(UnlistedVehicles::kMaxCandidates) - 1; ++id)
    EXPECT_NE(unlisted.admit(name_of(id), id, at_s(0)), "");
  EXPECT_EQ(unlisted.admit("steady", 1000, at_s(1)), "");
}

TEST(UnlistedVehicles, BeyondTheMostNobodyIsTrackedUntilOneLeaves) {
  UnlistedVehicles unlisted(for_s(kTimeout_s));
  for (VehicleId id = 1; id <= static_cast<VehicleId>(UnlistedVehicles::kMaxTracked); ++id) {
    if (!unlisted.admit(name_of(id), id, at_s(0)).empty()) {
      EXPECT_EQ(unlisted.admit(name_of(id), id, at_s(1)), "");
    }
  }
  EXPECT_THAT(unlisted.admit("more", 1000, at_s(0)), HasSubstr("too many"));
  EXPECT_THAT(unlisted.admit("more", 1000, at_s(1)), HasSubstr("too many"));
  unlisted.leave();
  EXPECT_NE(unlisted.admit("more", 1000, at_s(2)), "");
  EXPECT_EQ(unlisted.admit("more", 1000, at_s(3)), "");
}

}  // namespace
}  // namespace halocline::channel_server
