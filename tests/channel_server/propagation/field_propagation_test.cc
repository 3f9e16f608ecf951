// SPDX-License-Identifier: BSD-3-Clause
// Propagation through an ocean field: which water holds when, and what links make of it.
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/least_loss.h"
#include "acoustics/link/line_means.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "tests/channel_server/warming_sea.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::warming_sea;

LinkEnd end_at(VehicleId id, const Vec3& place, const acoustics::Modem& modem) {
  return {id, place, Vec3::Zero(), &modem};
}

TEST(WaterOfAField, HoldsForASpanAsItIsInItsMiddle) {
  const acoustics::Environment sea = warming_sea(2, 0);
  const EnvironmentTimeline waters(sea);
  const auto at = [](double seconds) { return SimTime::from_seconds(seconds); };
  EXPECT_EQ(waters.water_at(at(600)), waters.water_at(at(1199.9)));
  EXPECT_NE(waters.water_at(at(599.9)), waters.water_at(at(600)));
  const Vec3 place{100, 200, 20};
  EXPECT_EQ(sound_speed_at(waters.at(at(600)), place), sound_speed_at(waters.at(at(1100)), place));
  EXPECT_EQ(waters.at(at(1000)).field.time_s, 900);
  acoustics::Environment then = sea;
  then.field.time_s = 900;
  EXPECT_EQ(sound_speed_at(waters.at(at(1000)), place), sound_speed_at(then, place));
  EXPECT_NEAR(waters.at(at(1000)).profile.sound_speed_mps(20), sound_speed_at(then, {0, 0, 20}),
              tolerance(1e-9));
}

TEST(WaterOfAField, EndsWithAProfileThatIsAnnounced) {
  EnvironmentTimeline waters(warming_sea(2, 1));
  EnvironmentChange change;
  change.profile = acoustics::SoundSpeedProfile::isovelocity(1500, {10, 35});
  waters.schedule(SimTime::from_seconds(700), change);
  EXPECT_TRUE(waters.at(SimTime::from_seconds(650)).field);
  EXPECT_FALSE(waters.at(SimTime::from_seconds(700)).field);
  EXPECT_EQ(sound_speed_at(waters.at(SimTime::from_seconds(700)), {0, 0, 50}), 1500);
}

TEST(StraightPathThroughAField, TakesDelayAndAbsorptionAlongTheLine) {
  const acoustics::Environment sea = warming_sea(0, 0.8);
  const acoustics::Modem modem;
  const LinkEnd a = end_at(1, {-3000, 0, 20}, modem), b = end_at(2, {2500, 800, 50}, modem);
  StraightPropagation straight(sea);
  const Reception there = straight.reception(SimTime(), a, b), back = straight.reception(SimTime(), b, a);
  const double range = (b.position_ned_m - a.position_ned_m).norm();
  const acoustics::LineMeans means = means_along(straight.environment(SimTime()), a.position_ned_m,
                                                 b.position_ned_m, modem.band().centre_hz());
  EXPECT_NEAR(there.budget.delay_s, range * means.slowness_s_per_m, tolerance(1e-12));
  EXPECT_EQ(there.paths.front().delay_s, there.budget.delay_s);
  EXPECT_EQ(there.budget.delay_s, back.budget.delay_s);
  // In the water of the origin alone the level differs by what the line absorbs more.
  acoustics::Environment origin = environment_at(straight.environment(SimTime()), 0, 0);
  const Reception layered = StraightPropagation(origin).reception(SimTime(), a, b);
  EXPECT_GT(std::abs(there.budget.delay_s - layered.budget.delay_s), 1e-5);
  const double more_db = (means.absorption_db_per_km - layered.budget.absorption_db_per_km) * range / 1000;
  EXPECT_NEAR((layered.budget.received_level - there.budget.received_level).value, more_db, tolerance(1e-9));
}

// Reception along rays over a level bottom.
Reception along_rays(const acoustics::Environment& sea, const LinkEnd& from, const LinkEnd& to) {
  RayModel model;
  model.speed_tolerance_mps = 0.02;
  RayPropagation rays(std::make_shared<EnvironmentTimeline>(sea), std::make_shared<SeabedMap>(SeabedRule{}),
                      model);
  return rays.reception_over(SimTime(), from, to,
                             std::make_shared<const SeabedProfile>(SeabedProfile::flat(120)));
}

TEST(RaysThroughAField, AreTheLayeredOnesWhereItIsTheSameEverywhere) {
  const acoustics::Environment sea = warming_sea(0, 0);
  const acoustics::Modem modem;
  const LinkEnd a = end_at(1, {-2000, 0, 20}, modem), b = end_at(2, {1500, 800, 50}, modem);
  const Reception field = along_rays(sea, a, b), layered = along_rays(environment_at(sea, -2000, 0), a, b);
  ASSERT_GT(field.paths.size(), 5U);
  ASSERT_EQ(field.paths.size(), layered.paths.size());
  for (std::size_t i = 0; i < field.paths.size(); ++i) {
    EXPECT_EQ(field.paths[i].delay_s, layered.paths[i].delay_s);
    EXPECT_EQ(field.paths[i].level, layered.paths[i].level);
  }
}

// Of 300 links anywhere in the field, along the line and along rays; nor much more along the line, where
// absorption varies alone.
TEST(LeastLossThroughAField, NoLinkLosesLess) {
  const acoustics::Environment sea = warming_sea(2, 0.8);
  acoustics::Modem modem;
  StraightPropagation straight(sea);
  RayModel model;
  model.speed_tolerance_mps = 0.02;
  const RayPropagation rays(std::make_shared<EnvironmentTimeline>(sea),
                            std::make_shared<SeabedMap>(SeabedRule{}), model);
  const double frequency_hz = modem.band().centre_hz();
  const auto line = straight.least_loss(SimTime(), frequency_hz, 100),
             all = rays.least_loss(SimTime(), frequency_hz, 100);
  ASSERT_TRUE(line && all);
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto draw = [&](std::uint32_t what) { return uniform_at({.seed = 5, .who = what, .which = i}); };
    const Vec3 from(8000 * draw(0) - 4000, 8000 * draw(1) - 4000, 100 * draw(2)),
        to(8000 * draw(3) - 4000, 8000 * draw(4) - 4000, 100 * draw(5));
    const LinkEnd a = end_at(1, from, modem), b = end_at(2, to, modem);
    const double range_m = (to - from).norm();
    const double loss_db =
        (modem.source_level - straight.reception(SimTime(), a, b).budget.received_level).value;
    EXPECT_GE(loss_db, line->at(range_m).value - tolerance(1e-9));
    EXPECT_LE(loss_db, 1.15 * line->at(range_m).value + 0.01);
    if (i % 10 > 0) continue;
    const double ray_loss_db = (modem.source_level - along_rays(sea, a, b).budget.received_level).value;
    EXPECT_GE(ray_loss_db, all->at(std::hypot(to.x() - from.x(), to.y() - from.y())).value);
  }
}

// The direct path goes about as fast as on the average of both sides.
TEST(RaysThroughAField, GoFasterWhereItIsWarm) {
  const acoustics::Environment sea = warming_sea(0, 0.3);
  const acoustics::Modem modem;
  const LinkEnd a = end_at(1, {0, 0, 40}, modem), b = end_at(2, {1000, 0, 40}, modem);
  const Reception field = along_rays(sea, a, b), cold = along_rays(environment_at(sea, 0, 0), a, b),
                  warm = along_rays(environment_at(sea, 1000, 0), a, b);
  for (const Reception* one : {&field, &cold, &warm}) {
    ASSERT_FALSE(one->paths.empty());
    EXPECT_EQ(one->paths.front().surface_bounces + one->paths.front().bottom_bounces, 0);
  }
  const double apart = cold.paths.front().delay_s - warm.paths.front().delay_s;
  EXPECT_GT(apart, 1e-4);
  EXPECT_NEAR(cold.paths.front().delay_s - field.paths.front().delay_s, apart / 2, tolerance(0.1 * apart));
}

}  // namespace
}  // namespace halocline::channel_server
