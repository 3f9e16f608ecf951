// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/vehicle_registry.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using ::testing::ElementsAre;
using testing::for_s;
using ::testing::HasSubstr;
using testing::quick_modem;
using testing::state_at;

VehicleRegistry make_fleet() { return VehicleRegistry({for_s(0.05), for_s(5)}, {quick_modem(), {}}); }

TEST(VehicleRegistry, AVehicleIsPresentWhileItsStateIsFresh) {
  VehicleRegistry fleet = make_fleet();
  EXPECT_EQ(fleet.add_state("auv1", 1, state_at(10, {0, 0, 0})), "");
  EXPECT_TRUE(fleet.present(at_s(10.04)).empty());
  EXPECT_THAT(fleet.present(at_s(10.05)), ElementsAre(1));
  EXPECT_THAT(fleet.present(at_s(15)), ElementsAre(1));
  EXPECT_TRUE(fleet.present(at_s(15.001)).empty());
}

TEST(VehicleRegistry, PresentVehiclesComeByIdWhateverTheOrderOfTheirStates) {
  VehicleRegistry fleet = make_fleet();
  EXPECT_EQ(fleet.add_state("c", 3, state_at(0, {0, 0, 0})), "");
  EXPECT_EQ(fleet.add_state("a", 12, state_at(0, {0, 0, 0})), "");
  EXPECT_EQ(fleet.add_state("b", 2, state_at(0, {0, 0, 0})), "");
  EXPECT_THAT(fleet.present(at_s(1)), ElementsAre(2, 3, 12));
}

TEST(VehicleRegistry, TheFirstToClaimAnIdKeepsIt) {
  VehicleRegistry fleet = make_fleet();
  EXPECT_EQ(fleet.add_state("first", 1, state_at(0, {1, 0, 0})), "");
  EXPECT_THAT(fleet.add_state("second", 1, state_at(0.1, {2, 0, 0})), HasSubstr("belongs to first"));
  EXPECT_EQ(fleet.placement(1, at_s(1), at_s(1))->position_ned_m.x(), 1);
  EXPECT_FALSE(fleet.id_of("second"));
}

TEST(VehicleRegistry, AVehicleCannotChangeItsId) {
  VehicleRegistry fleet = make_fleet();
  EXPECT_EQ(fleet.add_state("auv1", 1, state_at(0, {0, 0, 0})), "");
  EXPECT_THAT(fleet.add_state("auv1", 2, state_at(0.1, {0, 0, 0})), HasSubstr("has the id 1"));
}

TEST(VehicleRegistry, AForgottenVehicleFreesItsId) {
  VehicleRegistry fleet = make_fleet();
  EXPECT_EQ(fleet.add_state("first", 1, state_at(0, {0, 0, 0})), "");
  fleet.forget_before(at_s(20));
  EXPECT_EQ(fleet.size(), 0u);
  EXPECT_EQ(fleet.add_state("second", 1, state_at(20, {0, 0, 0})), "");
  EXPECT_EQ(fleet.name_of(1), "second");
}

TEST(VehicleRegistry, AModemMayBeAnnouncedBeforeTheFirstState) {
  VehicleRegistry fleet = make_fleet();
  VehicleModem loud = quick_modem();
  loud.modem.source_level = {199};
  fleet.announce_modem("auv1", at_s(0), loud, at_s(0));
  EXPECT_EQ(fleet.add_state("auv1", 1, state_at(1, {0, 0, 0})), "");
  EXPECT_EQ(fleet.modem(1, at_s(2)).modem.source_level.value, 199);
}

TEST(VehicleRegistry, AVehicleWithoutAnnouncementCarriesTheModemOfItsScenario) {
  VehicleModem own = quick_modem();
  own.max_payload_bytes = 9;
  VehicleRegistry fleet({for_s(0.05), for_s(5)}, {quick_modem(), {{"auv2", own}}});
  EXPECT_EQ(fleet.add_state("auv1", 1, state_at(0, {0, 0, 0})), "");
  EXPECT_EQ(fleet.add_state("auv2", 2, state_at(0, {0, 0, 0})), "");
  EXPECT_EQ(fleet.modem(1, at_s(1)).max_payload_bytes, 64);
  EXPECT_EQ(fleet.modem(2, at_s(1)).max_payload_bytes, 9);
}

TEST(VehicleRegistry, TooManyVehiclesAreRefused) {
  VehicleRegistry fleet = make_fleet();
  for (const double time_s : {0.0, 0.1}) {
    for (VehicleId id = 1; id <= static_cast<VehicleId>(UnlistedVehicles::kMaxTracked); ++id) {
      const std::string problem = fleet.add_state(testing::name_of(id), id, state_at(time_s, {0, 0, 0}));
      EXPECT_TRUE(problem.empty() || time_s == 0) << problem;
    }
  }
  EXPECT_EQ(fleet.size(), UnlistedVehicles::kMaxTracked);
  EXPECT_THAT(fleet.add_state("one-more", 5000, state_at(0, {0, 0, 0})), HasSubstr("too many"));
}

TEST(VehicleRegistry, AFloodOfNamesLeavesTheVehiclesOfTheScenarioTheirPlaces) {
  VehicleRegistry fleet = make_fleet();
  for (VehicleId id = 1; id <= 20; ++id) fleet.reserve(testing::name_of(id), id);
  std::size_t taken = 0;
  for (VehicleId id = 1; id <= 50'000; ++id)
    taken += fleet.add_state("flood" + std::to_string(id), id, state_at(0, {0, 0, 0})).empty() ? 1 : 0;
  EXPECT_EQ(taken, UnlistedVehicles::kMaxAtOnce);
  EXPECT_THAT(fleet.add_state(testing::name_of(7), 70'000, state_at(0, {0, 0, 0})),
              HasSubstr("in the scenario"));
  for (VehicleId id = 1; id <= 20; ++id)
    EXPECT_EQ(fleet.add_state(testing::name_of(id), id, state_at(0, {0, 0, 0})), "");
  fleet.forget_before(at_s(100));
  EXPECT_EQ(fleet.size(), 0u);
  EXPECT_EQ(fleet.add_state("stranger", 60'000, state_at(100, {0, 0, 0})), "");
}

TEST(VehicleRegistry, AVehicleThatPublishesSteadilyFindsAPlaceInAFloodOfNames) {
  VehicleRegistry fleet = make_fleet();
  for (VehicleId id = 1; id <= 1000; ++id)
    (void)fleet.add_state("flood" + std::to_string(id), id, state_at(0, {0, 0, 0}));
  EXPECT_THAT(fleet.add_state("steady", 2000, state_at(0, {0, 0, 0})), HasSubstr("second STATE"));
  EXPECT_EQ(fleet.add_state("steady", 2000, state_at(1, {0, 0, 0})), "");
  EXPECT_EQ(fleet.name_of(2000), "steady");
}

TEST(VehicleRegistry, ModemsAnnouncedUnderForgedNamesKeepNobodyOutAndStayBounded) {
  VehicleRegistry fleet = make_fleet();
  VehicleModem loud = quick_modem();
  loud.modem.source_level = {199};
  for (int i = 0; i < 20'000; ++i) {
    fleet.announce_modem("forged" + std::to_string(i), at_s(0), quick_modem(), at_s(0));
  }
  EXPECT_EQ(fleet.announced(), VehicleRegistry::kMaxAnnounced);
  fleet.announce_modem("auv1", at_s(0), loud, at_s(0));
  for (int i = 0; i < 5000; ++i) {
    fleet.announce_modem("again" + std::to_string(i), at_s(0), quick_modem(), at_s(0));
  }
  EXPECT_EQ(fleet.add_state("auv1", 1, state_at(0.1, {0, 0, 0})), "");
  EXPECT_EQ(fleet.modem(1, at_s(1)).modem.source_level.value, 199);
}

TEST(VehicleRegistry, AModemAnnouncedWithoutAStateIsForgottenInTime) {
  VehicleRegistry fleet = make_fleet();
  fleet.announce_modem("early", at_s(0), VehicleModem{}, at_s(1));
  fleet.announce_modem("late", at_s(0), VehicleModem{}, at_s(9));
  fleet.announce_modem("repeated", at_s(0), VehicleModem{}, at_s(1));
  fleet.announce_modem("repeated", at_s(0), VehicleModem{}, at_s(8));
  fleet.forget_before(at_s(5));
  EXPECT_EQ(fleet.announced(), 2u);
  EXPECT_EQ(fleet.modem("early", at_s(10)), quick_modem());
  EXPECT_EQ(fleet.modem("late", at_s(10)), VehicleModem{});
  EXPECT_EQ(fleet.modem("repeated", at_s(10)), VehicleModem{});
}

TEST(VehicleRegistry, AForgottenVehicleTakesItsModemAlong) {
  VehicleRegistry fleet = make_fleet();
  EXPECT_EQ(fleet.add_state("auv1", 1, state_at(0, {0, 0, 0})), "");
  fleet.announce_modem("auv1", at_s(0), VehicleModem{}, at_s(0));
  fleet.forget_before(at_s(0));
  EXPECT_EQ(fleet.modem("auv1", at_s(1)), VehicleModem{}) << "its state is recent enough";
  fleet.forget_before(at_s(20));
  EXPECT_EQ(fleet.add_state("auv1", 1, state_at(20, {0, 0, 0})), "");
  EXPECT_EQ(fleet.modem(1, at_s(21)), quick_modem());
}

TEST(VehicleRegistry, ImpossibleRulesAreRefused) {
  EXPECT_THROW(VehicleRegistry({for_s(-0.1), for_s(5)}, {}), InvalidArgument);
  EXPECT_THROW(VehicleRegistry({for_s(0.1), for_s(0)}, {}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::channel_server
