// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/multipath_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/propagation/terrain_rays.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class MultipathCacheTest : public ::testing::Test {
 protected:
  PlacedVehicle vehicle(VehicleId id, double north_m) const {
    return {id, {Vec3(north_m, 0, 50), Vec3::Zero(), SimDuration()}, &modem_};
  }
  // A survey as the cache queries it, over a flat bottom at 100 m.
  EchoSurvey survey_of(const VehiclePair& pair) const {
    EchoSurvey survey(echoes_.place(pair.first), echoes_.place(pair.second), 3);
    survey.take_depths(std::vector<RayAnswer>(3, {RayAnswer::Kind::kHit, 100}));
    survey.take_ways(std::vector<RayAnswer>(6, {RayAnswer::Kind::kMiss, 0}));
    return survey;
  }
  std::vector<VehiclePair> begin_tick(const std::vector<PlacedVehicle>& vehicles, MultipathCache& echoes) {
    return echoes.begin_tick(vehicles, table_rows(vehicles));
  }
  std::vector<VehiclePair> begin_tick(const std::vector<PlacedVehicle>& vehicles) {
    return begin_tick(vehicles, echoes_);
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
  EXPECT_THAT(begin_tick({one, two}), ElementsAre(VehiclePair(1, 2)));
  EXPECT_EQ(row(one, two), Multipath::kUnknown);
  echoes_.store({1, 2}, survey_of({1, 2}));
  EXPECT_EQ(row(one, two), Multipath::kLikely);
  EXPECT_EQ(row(two, one), Multipath::kLikely);
}

TEST_F(MultipathCacheTest, ASurveyServesWhileBothEndsStayNear) {
  begin_tick({vehicle(1, 0), vehicle(2, 100)});
  echoes_.store({1, 2}, survey_of({1, 2}));
  EXPECT_THAT(begin_tick({vehicle(1, 4.9), vehicle(2, 104.9)}), IsEmpty());
  EXPECT_EQ(row(vehicle(1, 9), vehicle(2, 109)), Multipath::kLikely);
  EXPECT_THAT(begin_tick({vehicle(1, 5.1), vehicle(2, 100)}), ElementsAre(VehiclePair(1, 2)));
  EXPECT_EQ(row(vehicle(1, 5.1), vehicle(2, 100)), Multipath::kUnknown);
}

TEST_F(MultipathCacheTest, ThePairsQueriedLongestAgoComeFirst) {
  const std::vector<PlacedVehicle> fleet{vehicle(1, 0), vehicle(2, 100), vehicle(3, 200)};
  begin_tick(fleet);
  echoes_.note_queried({1, 2});
  EXPECT_THAT(begin_tick(fleet), ElementsAre(VehiclePair(1, 3), VehiclePair(2, 3), VehiclePair(1, 2)));
}

TEST_F(MultipathCacheTest, APairThatLeftIsForgotten) {
  begin_tick({vehicle(1, 0), vehicle(2, 100)});
  const EchoSurvey survey = survey_of({1, 2});
  begin_tick({vehicle(1, 0)});
  EXPECT_EQ(echoes_.surveys_kept(), 0u);
  echoes_.store({1, 2}, survey);  // its answer comes too late
  EXPECT_EQ(echoes_.surveys_kept(), 0u);
}

TEST_F(MultipathCacheTest, AnotherModemGetsItsOwnVerdict) {
  begin_tick({vehicle(1, 0), vehicle(2, 100)});
  echoes_.store({1, 2}, survey_of({1, 2}));
  EXPECT_EQ(row(vehicle(1, 0), vehicle(2, 100)), Multipath::kLikely);
  VehicleModem insensitive = modem_;
  insensitive.modem.min_receivable_level = {200};
  PlacedVehicle two = vehicle(2, 100);
  two.modem = &insensitive;
  EXPECT_EQ(row(vehicle(1, 0), two), Multipath::kUnlikely);
  EXPECT_EQ(row(two, vehicle(1, 0)), Multipath::kLikely);
}

TEST_F(MultipathCacheTest, PlacesOfNowAreServedBySurveysNearThem) {
  begin_tick({vehicle(1, 0), vehicle(2, 100)});
  echoes_.store({1, 2}, survey_of({1, 2}));
  EXPECT_EQ(echoes_.at(SimTime(), vehicle(1, 3), vehicle(2, 100), propagation_), Multipath::kLikely);
  EXPECT_EQ(echoes_.at(SimTime(), vehicle(1, 30), vehicle(2, 100), propagation_), Multipath::kUnknown);
}

TEST_F(MultipathCacheTest, WithoutReuseOnlyVehiclesAtRestAreServed) {
  MultipathCache strict(0);
  begin_tick({vehicle(1, 0), vehicle(2, 100)}, strict);
  EchoSurvey survey(strict.place(1), strict.place(2), 1);
  strict.store({1, 2}, survey);
  EXPECT_THAT(begin_tick({vehicle(1, 0), vehicle(2, 100)}, strict), IsEmpty());
  EXPECT_THAT(begin_tick({vehicle(1, 1e-6), vehicle(2, 100)}, strict), ElementsAre(VehiclePair(1, 2)));
}

}  // namespace
}  // namespace halocline::channel_server
