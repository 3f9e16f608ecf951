// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/environment_timeline.h"

#include <gtest/gtest.h>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/profile_drift.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::even_water;

constexpr std::int64_t kSession = 9;

EnvironmentChange wind(double mps) {
  EnvironmentChange change;
  change.wind_mps = mps;
  return change;
}

double wind_at(const EnvironmentTimeline& timeline, double time_s) {
  return timeline.at(at_s(time_s)).noise.wind_mps;
}

TEST(EnvironmentTimeline, StartsWithItsEnvironmentAndStaysSo) {
  const EnvironmentTimeline timeline(even_water());
  EXPECT_EQ(wind_at(timeline, -1e6), 0);
  EXPECT_EQ(wind_at(timeline, 1e6), 0);
  EXPECT_EQ(timeline.next_change_after(at_s(0)), SimTime::never());
}

TEST(EnvironmentTimeline, AChangeHoldsFromItsVeryInstant) {
  EnvironmentTimeline timeline(even_water());
  EXPECT_EQ(timeline.announce(at_s(10), at_s(5), {kSession, 0}, wind(7)), "");
  EXPECT_EQ(timeline.at(at_s(10) - SimDuration::from_nanoseconds(1)).noise.wind_mps, 0);
  EXPECT_EQ(wind_at(timeline, 10), 7);
  EXPECT_EQ(timeline.next_change_after(at_s(9)), at_s(10));
  EXPECT_EQ(timeline.next_change_after(at_s(10)), SimTime::never());
}

TEST(EnvironmentTimeline, WhatIsNotSetStaysAsItWas) {
  EnvironmentTimeline timeline(even_water());
  EXPECT_EQ(timeline.announce(at_s(10), at_s(0), {kSession, 0}, wind(7)), "");
  EnvironmentChange rest;
  rest.shipping = 0.9;
  rest.sea_surface_z_m = -2;
  rest.profile = acoustics::SoundSpeedProfile::isovelocity(1480, {5, 33});
  EXPECT_EQ(timeline.announce(at_s(20), at_s(0), {kSession, 1}, rest), "");
  const acoustics::Environment& late = timeline.at(at_s(20));
  EXPECT_EQ(late.noise.wind_mps, 7);
  EXPECT_EQ(late.noise.shipping, 0.9);
  EXPECT_EQ(late.sea_surface_z_m, -2);
  EXPECT_EQ(late.profile.sound_speed_mps(10), 1480);
  EXPECT_EQ(timeline.at(at_s(15)).noise.shipping, even_water().noise.shipping);
}

TEST(EnvironmentTimeline, TheOrderOfAnnouncementsDoesNotMatter) {
  EnvironmentTimeline one(even_water()), other(even_water());
  const auto announce = [](EnvironmentTimeline& timeline, int n) {
    EXPECT_EQ(timeline.announce(at_s(n < 3 ? 10 : 20), at_s(0), {kSession, n}, wind(n)), "");
  };
  for (const int n : {1, 2, 3, 4}) announce(one, n);
  for (const int n : {4, 2, 1, 3}) announce(other, n);
  for (const double time_s : {5.0, 10.0, 15.0, 20.0}) {
    EXPECT_EQ(wind_at(one, time_s), wind_at(other, time_s)) << time_s;
  }
  EXPECT_EQ(wind_at(one, 15), 2);
  EXPECT_EQ(wind_at(one, 25), 4);
}

TEST(EnvironmentTimeline, ALateChangeHoldsFromItsReception) {
  EnvironmentTimeline timeline(even_water());
  EXPECT_EQ(timeline.announce(at_s(10), at_s(12), {kSession, 0}, wind(7)), "");
  EXPECT_EQ(wind_at(timeline, 11.9), 0);
  EXPECT_EQ(wind_at(timeline, 12), 7);
}

TEST(EnvironmentTimeline, ARepetitionChangesNothing) {
  EnvironmentTimeline timeline(even_water());
  EXPECT_EQ(timeline.announce(at_s(10), at_s(0), {kSession, 0}, wind(7)), "");
  const auto water = timeline.water_at(at_s(10));
  EXPECT_EQ(timeline.announce(at_s(10), at_s(3), {kSession, 0}, wind(7)), "");
  EXPECT_EQ(timeline.water_at(at_s(10)), water);
}

TEST(EnvironmentTimeline, WatersBeforeAChangeKeepTheirIdentity) {
  EnvironmentTimeline timeline(even_water());
  EXPECT_EQ(timeline.announce(at_s(10), at_s(0), {kSession, 0}, wind(7)), "");
  const auto early = timeline.water_at(at_s(5)), middle = timeline.water_at(at_s(15));
  EXPECT_EQ(timeline.announce(at_s(20), at_s(0), {kSession, 1}, wind(9)), "");
  EXPECT_EQ(timeline.water_at(at_s(5)), early);
  EXPECT_EQ(timeline.water_at(at_s(15)), middle);
  EXPECT_NE(timeline.water_at(at_s(25)), middle);
}

TEST(EnvironmentTimeline, ImpossibleChangesAreRefusedWithTheReason) {
  EnvironmentTimeline timeline(even_water());
  EXPECT_NE(timeline.announce(at_s(10), at_s(0), {kSession, 0}, wind(61)), "");
  EXPECT_EQ(wind_at(timeline, 10), 0);
  EXPECT_THROW(timeline.schedule(at_s(1), wind(-1)), InvalidArgument);
}

TEST(EnvironmentTimeline, AnotherRunKeepsTheScheduleAlone) {
  EnvironmentTimeline timeline(even_water());
  timeline.schedule(at_s(10), wind(3));
  EXPECT_EQ(timeline.announce(at_s(5), at_s(0), {kSession, 0}, wind(7)), "");
  timeline.clear();
  EXPECT_EQ(wind_at(timeline, 5), 0);
  EXPECT_EQ(wind_at(timeline, 10), 3);
}

TEST(EnvironmentTimeline, AnyNumberOfChangesIsTakenWhenTheOldAreForgotten) {
  EnvironmentTimeline timeline(even_water());
  timeline.schedule(at_s(5.5), wind(3));
  for (int i = 0; i < 30'000; ++i) {
    ASSERT_EQ(timeline.announce(at_s(i), at_s(i), {kSession, i}, wind(i % 20)), "");
    timeline.forget_before(at_s(i - 130));
    ASSERT_LE(timeline.changes_kept(), EnvironmentTimeline::kAnnouncedKept + 200);
  }
  EXPECT_EQ(wind_at(timeline, 29'999), 19);
  EXPECT_EQ(wind_at(timeline, 29'900.5), 0);
  EXPECT_EQ(timeline.announce(at_s(29'500), at_s(30'000), {kSession, 29'500}, wind(9)), "");  // a repetition
  EXPECT_EQ(wind_at(timeline, 30'001), 19);
  timeline.clear();
  EXPECT_EQ(wind_at(timeline, 6), 3);
}

acoustics::Environment drifting_water() {
  acoustics::Environment water = even_water();
  water.drift = {.spread_mps = 0.3, .depth_m = 100, .seed = 4};
  return water;
}

double speed_at(const EnvironmentTimeline& timeline, double time_s) {
  return timeline.at(at_s(time_s)).profile.sound_speed_mps(0);
}

// dc at the surface is the sum of both amplitudes.
TEST(EnvironmentTimeline, AProfileDriftsInBlocksOf600Seconds) {
  const EnvironmentTimeline timeline(drifting_water());
  const double even = even_water().profile.sound_speed_mps(0);
  for (const int block : {0, 1, 7, 100}) {
    const auto [first, second] = drift_amplitudes(drifting_water().drift, block);
    const double begin_s = 600.0 * block;
    EXPECT_NEAR(speed_at(timeline, begin_s), even + first + second, 1e-9);
    EXPECT_EQ(speed_at(timeline, begin_s + 599.9), speed_at(timeline, begin_s));
    EXPECT_NE(speed_at(timeline, begin_s + 600), speed_at(timeline, begin_s));
    EXPECT_EQ(timeline.water_at(at_s(begin_s + 599.9)), timeline.water_at(at_s(begin_s)));
    EXPECT_NE(timeline.water_at(at_s(begin_s + 600)), timeline.water_at(at_s(begin_s)));
  }
}

TEST(EnvironmentTimeline, EveryProcessHasTheSameDriftWhateverItIsAskedFor) {
  const EnvironmentTimeline one(drifting_water());
  EnvironmentTimeline other(drifting_water());
  speed_at(other, 1e6);
  EXPECT_EQ(other.announce(at_s(7000), at_s(0), {kSession, 0}, wind(7)), "");
  other.forget_before(at_s(6500));
  for (const double time_s : {6600.0, 1e5}) EXPECT_EQ(speed_at(other, time_s), speed_at(one, time_s));
}

TEST(EnvironmentTimeline, AnAnnouncedProfileDriftsToo) {
  EnvironmentTimeline timeline(drifting_water());
  EnvironmentChange change;
  change.profile = acoustics::SoundSpeedProfile::isovelocity(1480, {5, 33});
  const double drift = speed_at(timeline, 1300) - even_water().profile.sound_speed_mps(0);
  EXPECT_EQ(timeline.announce(at_s(100), at_s(0), {kSession, 0}, change), "");
  EXPECT_NEAR(speed_at(timeline, 1300), 1480 + drift, 1e-9);
}

TEST(EnvironmentTimeline, ForgettingKeepsTheWaterOfLaterInstants) {
  EnvironmentTimeline all(even_water()), forgetting(even_water());
  for (int i = 0; i < 3000; ++i) {
    for (EnvironmentTimeline* timeline : {&all, &forgetting})
      ASSERT_EQ(timeline->announce(at_s(i), at_s(i), {kSession, i}, wind((i * 7) % 30)), "");
    forgetting.forget_before(at_s(i - 50));
    ASSERT_EQ(wind_at(forgetting, i - 49.5), wind_at(all, i - 49.5)) << i;
    ASSERT_EQ(wind_at(forgetting, i), wind_at(all, i)) << i;
  }
}

// Half a step of at most a millimetre, and the tide's own formula.
TEST(EnvironmentTimeline, ATideMovesTheSurfaceAboutTheMeanThatHolds) {
  acoustics::Environment water = even_water();
  water.sea_surface_z_m = -1;
  water.tide = {{{.amplitude_m = 2}, {.amplitude_m = 0.3, .period_s = 86'400, .phase_rad = 1}}};
  EnvironmentTimeline timeline(water);
  EnvironmentChange change;
  change.sea_surface_z_m = 3;
  timeline.schedule(at_s(50'000), change);
  for (double t = 0; t < 100'000; t += 1234.5) {
    const double mean = t < 50'000 ? -1 : 3;
    EXPECT_NEAR(timeline.at(at_s(t)).sea_surface_z_m, mean - water.tide.height_m(t),
                EnvironmentTimeline::kTideStepM / 2 + 1e-9)
        << t;
  }
  EXPECT_NE(timeline.water_at(at_s(1000)), timeline.water_at(at_s(2000)));
  EXPECT_EQ(timeline.water_at(at_s(1000)), timeline.water_at(at_s(1000.01)));
  const double there = timeline.at(at_s(1000)).sea_surface_z_m;
  timeline.forget_before(at_s(90'000));
  EXPECT_EQ(timeline.at(at_s(1000)).sea_surface_z_m, there);
}

TEST(EnvironmentTimeline, WithoutATideTheWaterIsOne) {
  const EnvironmentTimeline timeline(even_water());
  EXPECT_EQ(timeline.water_at(at_s(0)), timeline.water_at(at_s(1e6)));
}

TEST(EnvironmentTimeline, UnderIceAnnouncedWindDoesNothing) {
  acoustics::Environment water = even_water();
  water.ice.kind = acoustics::IceKind::kFast;
  EnvironmentTimeline timeline(water);
  EXPECT_EQ(timeline.announce(at_s(10), at_s(5), {kSession, 0}, wind(7)), "");
  EXPECT_EQ(wind_at(timeline, 20), 0);
}

}  // namespace
}  // namespace halocline::channel_server
