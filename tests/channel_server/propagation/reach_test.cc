// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/reach.h"

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/noise.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using acoustics::LeastLoss;
using halocline::testing::tolerance;
using testing::at_s;
using testing::for_s;

acoustics::Environment windy_water(double wind_mps) {
  acoustics::Environment water = testing::even_water();
  water.noise.wind_mps = wind_mps;
  return water;
}

VehicleModem modem_of(double source_level_db) {
  VehicleModem modem = testing::quick_modem();
  modem.modem.source_level = Decibels{source_level_db};
  modem.modem.preamble = modem.modem.packet_overhead = for_s(0.1);
  return modem;
}

class Reach : public ::testing::Test {
 protected:
  void SetUp() override {
    EXPECT_EQ(fleet_.add_state("v1", 1, testing::state_at(0, {0, 0, 20})), "");
    EXPECT_EQ(fleet_.add_state("v2", 2, testing::state_at(0, {500, 0, 20})), "");
  }
  double reach_m(const acoustics::Modem& sender, const ReachRule& rule = {}, double time_s = 1) {
    const StraightPropagation propagation(waters_);
    return ReachModel(waters_, propagation, rule)
        .reach_m(at_s(time_s), sender, fleet_, place_all(fleet_, at_s(time_s)));
  }
  acoustics::Modem modem_ = modem_of(160).modem;
  std::shared_ptr<EnvironmentTimeline> waters_ = std::make_shared<EnvironmentTimeline>(windy_water(5));
  VehicleRegistry fleet_{{for_s(0.05), for_s(50)}, {modem_of(160), {}}};
};

TEST(StraightBound, NoStraightLinkLosesLess) {
  const acoustics::Environment water = windy_water(5);
  const acoustics::Modem modem = modem_of(160).modem;
  const acoustics::LinkModel link(water, modem, modem);
  const LeastLoss least = LeastLoss::of_straight_path(water, modem.centre_frequency_hz, 400);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto draw = [&](std::uint32_t what) { return uniform_at({.seed = 3, .who = what, .which = i}); };
    const Vec3 from(0, 0, 400 * draw(0)), to(std::pow(10, 4.5 * draw(1)), 0, 400 * draw(2));
    const double range_m = (to - from).norm();
    const double loss_db = link.budget(from, to).transmission_loss.value;
    EXPECT_GE(loss_db, least.at(range_m).value - tolerance(1e-9));
    EXPECT_LE(loss_db, 1.05 * least.at(range_m).value + 0.01);  // nor much more: absorption varies with depth
  }
}

TEST(LeastLoss, TheRangeOfALossIsWhereItIsReached) {
  const acoustics::Environment water = windy_water(5);
  for (const LeastLoss& least : {LeastLoss::of_straight_path(water, 25'000, 100),
                                 LeastLoss::of_rays(water, 25'000, 100, Decibels{3})}) {
    for (const double range_m : {3.0, 200.0, 4000.0, 60'000.0}) {
      EXPECT_NEAR(least.range_of(least.at(range_m)), range_m, 2e-6 * range_m);
    }
    EXPECT_EQ(least.range_of(Decibels{-100}), 0);
    EXPECT_EQ(least.range_of(Decibels{1e9}), acoustics::kMaxBoundedRange);
  }
}

// In lossless even water rays spread as the images of a source between walls: pi / (H r) + 2 / r^2; at 10 Hz
// nothing absorbs.
TEST(LeastLoss, OfRaysIsThatOfAChannelWithoutLosses) {
  const LeastLoss least = LeastLoss::of_rays(windy_water(0), 10, 100, Decibels{0});
  const double images = std::acos(-1) / (acoustics::kChannelThickness * 3000) + 2 / 9e6;
  EXPECT_NEAR(least.at(3000).value, -10 * std::log10(images) - acoustics::kFocusingGain.value, 0.01);
}

// Where the water is known to be no shallower, the bottom takes its share: the further, the more; in deeper
// water the less.
TEST(LeastLoss, OfRaysGrowsByWhatTheBottomTakes) {
  const auto at = [](double range_m, double least_depth_m) {
    const acoustics::WaterLimits column{least_depth_m, 1000, *acoustics::sediment("MediumSand")};
    return LeastLoss::of_rays(windy_water(0), 10, 100, Decibels{0}, column).at(range_m).value;
  };
  EXPECT_EQ(at(3000, 0), LeastLoss::of_rays(windy_water(0), 10, 100, Decibels{0}).at(3000).value);
  EXPECT_GT(at(3000, 75), at(3000, 0) + 5);
  EXPECT_GT(at(10'000, 75) - at(10'000, 0), at(3000, 75) - at(3000, 0));
  EXPECT_GT(at(3000, 150), at(3000, 75));
}

// No ray over a rough bottom is louder.
TEST(LeastLoss, OfRaysBoundsTheLevelsOfARoughChannel) {
  const acoustics::FluidBottom sand = *acoustics::sediment("MediumSand");
  const acoustics::Environment water = windy_water(0);
  const acoustics::LeastLoss least = LeastLoss::of_rays(water, 25'000, 100, Decibels{0}, {130, 170, sand});
  for (std::uint32_t i = 0; i < 30; ++i) {
    const double range_m = 500 + 100 * i;
    acoustics::RaySea sea{
        acoustics::ray_water(water, 25'000), acoustics::rough_bottom(i, range_m), sand, {}, {}};
    double power = 0;
    for (const auto& path : eigenrays(sea, {20.0 + 3 * i, 110.0 - 3 * i, range_m}).paths)
      power += path.received_pressure() * path.received_pressure();
    EXPECT_GT(-10 * std::log10(power), least.at(range_m).value) << range_m;
  }
}

// A preamble counts less the more seldom it may be acquired; what disturbs is the same.
TEST_F(Reach, IsShorterTheMoreOftenAPreambleMayBeMissed) {
  const acoustics::FadingModel fading{.enabled = true};
  const ReachRule usual{.below_noise = Decibels{0}, .fading = fading};
  modem_.min_receivable_level = Decibels{-200};  // the preamble decides
  ReachRule careless = usual;
  careless.acquired_once_in = 1000;
  EXPECT_LT(reach_m(modem_, careless), reach_m(modem_, usual));
}

TEST_F(Reach, DisturbsDownToItsLevelBelowTheNoise) {
  const StraightPropagation propagation(waters_);
  const ReachModel by_level(waters_, propagation, {.below_noise = Decibels{20}}),
      none(waters_, propagation, {.by_level = false});
  EXPECT_TRUE(by_level.disturbs(0.0101, 1));
  EXPECT_FALSE(by_level.disturbs(0.0099, 1));
  EXPECT_TRUE(none.disturbs(1e-12, 1));
}

TEST_F(Reach, AtItsEndTheLevelIsTheLeastThatMatters) {
  const double reach = reach_m(modem_);
  const double level_db =
      acoustics::link_budget(waters_->at(at_s(1)), modem_, modem_, {0, 0, 20}, {reach, 0, 20})
          .received_level.value;
  const double noise_db = acoustics::noise_level_over_band(22'500, 27'500, {.wind_mps = 5}).value;
  // Noise falls by 2 dB over the band, of which the least counts; absorption is taken with a margin of 0.5 %.
  EXPECT_NEAR(level_db, noise_db - 30 - 1, 1);
}

TEST_F(Reach, GrowsWithSourceLevelAndDirectivityAndFallsWithNoise) {
  const double reach = reach_m(modem_);
  acoustics::Modem louder = modem_;
  louder.source_level = Decibels{180};
  EXPECT_GT(reach_m(louder), reach + 1000);
  ReachRule wider;
  wider.below_noise = Decibels{50};
  EXPECT_GT(reach_m(modem_, wider), reach + 1000);
  ReachRule fading;
  fading.fading.enabled = true;
  acoustics::Modem without_cut_off = modem_;
  without_cut_off.min_receivable_level = Decibels{-200};
  EXPECT_GT(reach_m(without_cut_off, fading), reach_m(without_cut_off) + 500);
  VehicleModem keen = modem_of(160);
  keen.modem.directivity_index = Decibels{15};
  fleet_.announce_modem("v2", at_s(0), keen, at_s(0));
  EXPECT_GT(reach_m(modem_), reach + 1000);
  fleet_.announce_modem("v2", at_s(0.5), modem_of(160), at_s(0));
  waters_ = std::make_shared<EnvironmentTimeline>(windy_water(20));
  EXPECT_LT(reach_m(modem_), reach - 500);
}

TEST_F(Reach, IncludesNoiseAndModemsThatAreKnownToChangeDuringTheFlight) {
  const double reach = reach_m(modem_);
  waters_->schedule(at_s(30), {.wind_mps = 0, .shipping = {}, .sea_surface_z_m = {}, .profile = {}});
  const double calm = reach_m(modem_);
  EXPECT_GT(calm, reach + 500);
  VehicleModem keen = modem_of(160);
  keen.modem.directivity_index = Decibels{15};
  fleet_.announce_modem("v2", at_s(20), keen, at_s(0));
  EXPECT_GT(reach_m(modem_), calm + 1000);
}

// A modem without a preamble and without a cut-off acquires whatever arrives; the noise does not hide it.
TEST_F(Reach, IsTheCutOffsWithoutAPreamble) {
  VehicleModem deaf = modem_of(160);
  deaf.modem.preamble = SimDuration();
  deaf.modem.min_receivable_level = Decibels{20};
  for (const char* name : {"v1", "v2"}) fleet_.announce_modem(name, at_s(0), deaf, at_s(0));
  const double reach = reach_m(deaf.modem);
  const auto budget =
      acoustics::link_budget(waters_->at(at_s(1)), deaf.modem, deaf.modem, {0, 0, 20}, {reach, 0, 20});
  EXPECT_NEAR(budget.received_level.value, 20, 1);
  EXPECT_LE(budget.received_level.value, 20);
}

TEST_F(Reach, EverybodyIsWithinReachWithoutARule) {
  ReachRule none;
  none.by_level = false;
  EXPECT_EQ(reach_m(modem_, none), acoustics::kMaxBoundedRange);
}

class ReceptionRange : public Reach {
 protected:
  std::vector<double> ranges_m(const ReachRule& rule = {}) {
    const StraightPropagation propagation(waters_, rule.fading);
    LinkPredictor predictor({.fading = rule.fading, .profiles = {}});
    ReachModel model(waters_, propagation, rule);
    return model.reception_ranges_m(at_s(1), fleet_, place_all(fleet_, at_s(1)),
                                    [&](const acoustics::Modem& m) { return predictor.least_sinr_db(m); });
  }
  // Of a packet of 32 bytes over `range_m`, both ends 20 m deep.
  double delivery_at(double range_m, const acoustics::FadingModel& fading) {
    StraightPropagation propagation(waters_, fading);
    LinkPredictor predictor({.fading = fading, .profiles = {}});
    const LinkEnd from{1, {0, 0, 20}, Vec3::Zero(), &modem_}, to{2, {range_m, 0, 20}, Vec3::Zero(), &modem_};
    const Reception reception = propagation.reception(at_s(1), from, to);
    return predictor.forecast(*predictor.rates_of(modem_), modem_, modem_, reception).delivery_probability;
  }
};

// The cut-off is far below the noise: the noise alone decides.
TEST_F(ReceptionRange, BeyondItAPacketInAThousandIsReceivedAtMost) {
  VehicleModem keen = modem_of(160);
  keen.modem.min_receivable_level = Decibels{-200};
  modem_ = keen.modem;
  for (const char* name : {"v1", "v2"}) fleet_.announce_modem(name, at_s(0), keen, at_s(0));
  ReachRule fading;
  fading.fading.enabled = true;
  for (const ReachRule& rule : {ReachRule(), fading}) {
    const double range_m = ranges_m(rule)[0];
    for (const double further : {1.001, 1.1, 2.0}) {
      EXPECT_LT(delivery_at(further * range_m, rule.fading), 1e-3) << further;
    }
    // Nor is it much longer than the range at which one is.
    EXPECT_GT(delivery_at(0.75 * range_m, rule.fading), 1e-3);
    EXPECT_LT(range_m, 0.7 * reach_m(modem_, rule));
  }
}

TEST_F(ReceptionRange, IsNoMoreThanATablesRange) {
  ReachRule near;
  near.table_range_m = 1234;
  EXPECT_EQ(ranges_m(near), std::vector<double>(2, 1234));
  near.by_level = false;
  EXPECT_EQ(ranges_m(near), std::vector<double>(2, 1234));
}

TEST_F(ReceptionRange, IsThatOfEachModemOfAFleet) {
  fleet_.announce_modem("v2", at_s(0), modem_of(180), at_s(0));
  const auto ranges = ranges_m();
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_GT(ranges[1], ranges[0] + 1000);
  ReachRule none;
  none.by_level = false;
  EXPECT_EQ(ranges_m(none), std::vector<double>(2, acoustics::kMaxBoundedRange));
}

// It is met where both will be: the range shrinks by v t while the sound goes r / c.
TEST(StaysBeyond, AReceiverThatComesTowardsTheSoundIsGivenItsWay) {
  EXPECT_TRUE(stays_beyond(1000, 1004, 0));
  EXPECT_FALSE(stays_beyond(1000, 1003, 0));
  EXPECT_FALSE(stays_beyond(1000, 1035, 45));
  EXPECT_TRUE(stays_beyond(1000, 1045, 45));
}

}  // namespace
}  // namespace halocline::channel_server
