// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/multipath_cache.h"

#include <gtest/gtest.h>

#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/propagation/terrain_rays.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

class MultipathCacheTest : public ::testing::Test {
 protected:
  PlacedVehicle vehicle(VehicleId id, double north_m) const {
    return {id, {Vec3(north_m, 0, 50), Vec3::Zero(), SimDuration()}, &modem_};
  }
  // Over a flat bottom at 100 m, from where the first vehicle is to where the second is.
  EchoSurvey survey_between(double first_north_m, double second_north_m) const {
    EchoSurvey survey({first_north_m, 0, 50}, {second_north_m, 0, 50}, 3);
    survey.take_depths(std::vector<RayAnswer>(3, {RayAnswer::Kind::kHit, 100}));
    survey.take_ways(std::vector<RayAnswer>(6, {RayAnswer::Kind::kMiss, 0}));
    return survey;
  }
  Multipath row(const PlacedVehicle& from, const PlacedVehicle& to) {
    return echoes_.at_last_tick(SimTime(), from, to, propagation_);
  }

  VehicleModem modem_ = testing::quick_modem();
  StraightPropagation propagation_{testing::even_water()};
  MultipathCache echoes_{5};
};

TEST_F(MultipathCacheTest, KnowsNothingBeforeTheFirstTick) {
  EXPECT_EQ(row(vehicle(1, 0), vehicle(2, 100)), Multipath::kUnknown);
}

TEST_F(MultipathCacheTest, ARowHoldsTheEchoesOfTheTickBefore) {
  const auto one = vehicle(1, 0), two = vehicle(2, 100);
  echoes_.begin_tick({one, two});
  EXPECT_EQ(row(one, two), Multipath::kUnknown);
  echoes_.store({1, 2}, survey_between(0, 100));
  EXPECT_EQ(row(one, two), Multipath::kLikely);
  EXPECT_EQ(row(two, one), Multipath::kLikely);
}

TEST_F(MultipathCacheTest, ASurveyServesWhileBothEndsStayNear) {
  echoes_.begin_tick({vehicle(1, 0), vehicle(2, 100)});
  echoes_.store({1, 2}, survey_between(0, 100));
  echoes_.begin_tick({vehicle(1, 4.9), vehicle(2, 104.9)});
  EXPECT_EQ(row(vehicle(1, 9), vehicle(2, 109)), Multipath::kLikely);
  echoes_.begin_tick({vehicle(1, 5.1), vehicle(2, 100)});
  EXPECT_EQ(row(vehicle(1, 5.1), vehicle(2, 100)), Multipath::kUnknown);
}

TEST_F(MultipathCacheTest, APairThatLeftIsForgotten) {
  echoes_.begin_tick({vehicle(1, 0), vehicle(2, 100)});
  const EchoSurvey survey = survey_between(0, 100);
  echoes_.begin_tick({vehicle(1, 0)});
  EXPECT_EQ(echoes_.surveys_kept(), 0u);
  echoes_.store({1, 2}, survey);  // its answer comes too late
  EXPECT_EQ(echoes_.surveys_kept(), 0u);
}

TEST_F(MultipathCacheTest, AnotherModemGetsItsOwnVerdict) {
  echoes_.begin_tick({vehicle(1, 0), vehicle(2, 100)});
  echoes_.store({1, 2}, survey_between(0, 100));
  EXPECT_EQ(row(vehicle(1, 0), vehicle(2, 100)), Multipath::kLikely);
  VehicleModem insensitive = modem_;
  insensitive.modem.min_receivable_level = {200};
  PlacedVehicle two = vehicle(2, 100);
  two.modem = &insensitive;
  EXPECT_EQ(row(vehicle(1, 0), two), Multipath::kUnlikely);
  EXPECT_EQ(row(two, vehicle(1, 0)), Multipath::kLikely);
}

TEST_F(MultipathCacheTest, PlacesOfNowAreServedBySurveysNearThem) {
  echoes_.begin_tick({vehicle(1, 0), vehicle(2, 100)});
  echoes_.store({1, 2}, survey_between(0, 100));
  EXPECT_EQ(echoes_.at(SimTime(), vehicle(1, 3), vehicle(2, 100), propagation_), Multipath::kLikely);
  EXPECT_EQ(echoes_.at(SimTime(), vehicle(1, 30), vehicle(2, 100), propagation_), Multipath::kUnknown);
}

TEST_F(MultipathCacheTest, WithoutReuseOnlyVehiclesAtRestAreServed) {
  MultipathCache strict(0);
  strict.begin_tick({vehicle(1, 0), vehicle(2, 100)});
  strict.store({1, 2}, survey_between(0, 100));
  EXPECT_EQ(strict.at(SimTime(), vehicle(1, 0), vehicle(2, 100), propagation_), Multipath::kLikely);
  EXPECT_EQ(strict.at(SimTime(), vehicle(1, 1e-6), vehicle(2, 100), propagation_), Multipath::kUnknown);
}

}  // namespace
}  // namespace halocline::channel_server
