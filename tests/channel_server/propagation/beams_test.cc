// SPDX-License-Identifier: BSD-3-Clause
// A modem's pattern in elevation weighs the paths of sound at both ends, by rays and by the straight path.
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/link/bottom_echo.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/link/received_field.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;

constexpr double kEdge = std::numbers::pi / 6;  // 30 degrees
constexpr double kDown20Db = 20;

acoustics::Modem with_beam(std::vector<acoustics::BeamRow> rows) {
  acoustics::Modem modem;
  modem.beam = acoustics::BeamPattern(std::move(rows));
  return modem;
}

// 20 dB down steeper than 30 degrees, either way.
acoustics::Modem flat_looking() {
  const double steep = kEdge + 1e-6;
  return with_beam({{-steep, kDown20Db}, {-kEdge, 0}, {kEdge, 0}, {steep, kDown20Db}});
}
// A modem that receives and sends below it.
acoustics::Modem down_looking() { return with_beam({{-0.01, kDown20Db}, {0.01, 0}}); }

struct Sea {
  acoustics::Environment water = even_water();
  double depth_m = 100;
  RayModel model;
};

Reception by_rays(const Sea& sea, const LinkEnd& from, const LinkEnd& to) {
  RayPropagation rays(std::make_shared<EnvironmentTimeline>(sea.water),
                      std::make_shared<SeabedMap>(SeabedRule{}), sea.model);
  return rays.reception_over(at_s(0), from, to,
                             std::make_shared<const SeabedProfile>(SeabedProfile::flat(sea.depth_m)));
}

Reception by_line(const LinkEnd& from, const LinkEnd& to) {
  StraightPropagation straight(even_water());
  return straight.reception(at_s(0), from, to);
}

LinkEnd end_at(const Vec3& place, const acoustics::Modem& modem) { return {0, place, Vec3::Zero(), &modem}; }

// Every path with a beam against the same path without: `weight` is what is to be missing.
template <class Weight>
void expect_paths_weighed(const Reception& with, const Reception& without, Weight weight) {
  ASSERT_EQ(with.paths.size(), without.paths.size());
  for (std::size_t i = 0; i < with.paths.size(); ++i) {
    const Arrival &path = with.paths[i], &plain = without.paths[i];
    EXPECT_NEAR(plain.level.value - path.level.value, weight(plain), tolerance(1e-9)) << i;
    EXPECT_EQ(path.delay_s, plain.delay_s);
    EXPECT_EQ(path.doppler_factor, plain.doppler_factor);
  }
}

// 60 m apart in 100 m of water: the direct path is flat, all bounces at the bottom are steep.
TEST(Beams, ATransmitterTwentyDecibelsDownAboveThirtyDegreesTakesThemFromSteepPathsAndNothingFromFlatOnes) {
  const acoustics::Modem beam = flat_looking(), plain;
  const Vec3 from(0, 0, 20), to(60, 0, 30);
  int flat = 0, steep = 0;
  expect_paths_weighed(by_rays({}, end_at(from, beam), end_at(to, plain)),
                       by_rays({}, end_at(from, plain), end_at(to, plain)), [&](const Arrival& path) {
                         const bool is_steep = std::abs(path.launch_angle_rad) > kEdge;
                         ++(is_steep ? steep : flat);
                         return is_steep ? kDown20Db : 0;
                       });
  EXPECT_GE(flat, 1);
  EXPECT_GE(steep, 3);
}

// Sound that travels upwards where it arrives comes from below.
TEST(Beams, AReceiverThatLooksDownLosesWhatComesFromAbove) {
  const acoustics::Modem beam = down_looking(), plain;
  const Vec3 from(0, 0, 40), to(300, 0, 50);
  int from_above = 0, from_below = 0;
  const Reception without = by_rays({}, end_at(from, plain), end_at(to, plain));
  expect_paths_weighed(by_rays({}, end_at(from, plain), end_at(to, beam)), without, [&](const Arrival& path) {
    const bool travels_down = path.arrival_angle_rad > 0;
    ++(travels_down ? from_above : from_below);
    return travels_down ? kDown20Db : 0;
  });
  EXPECT_GE(from_above, 2);
  EXPECT_GE(from_below, 2);
  for (const Arrival& path :
       without.paths) {  // one bounce at the bottom comes from below, at the surface from above
    if (path.surface_bounces + path.bottom_bounces == 1) {
      EXPECT_EQ(path.arrival_angle_rad < 0, path.bottom_bounces == 1);
    }
  }
}

TEST(Beams, ATransmitterThatLooksDownSendsNothingUp) {
  const acoustics::Modem beam = down_looking(), plain;
  const Vec3 from(0, 0, 40), to(300, 0, 50);
  expect_paths_weighed(by_rays({}, end_at(from, beam), end_at(to, plain)),
                       by_rays({}, end_at(from, plain), end_at(to, plain)),
                       [&](const Arrival& path) { return path.launch_angle_rad < 0 ? kDown20Db : 0; });
}

// At 1 MHz water takes about 320 dB/km: over 19 km a double still holds the sound (down by some 6100 dB), and
// no longer where beams take 400 dB more.
TEST(Beams, PathsThatABeamSilencesAreLeftOut) {
  acoustics::Modem plain;
  plain.centre_frequency_hz = 1e6;
  acoustics::Modem insensitive = plain;
  insensitive.beam = acoustics::BeamPattern({{0, 200}});
  const Vec3 from(0, 0, 2400), to(19'000, 0, 2500);
  const auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  testing::survey(*seabed, from, to, [](const Vec3&) { return 5000.0; });
  RayPropagation rays(std::make_shared<EnvironmentTimeline>(even_water()), seabed, {});
  const auto received = [&](const acoustics::Modem& modem) {
    return rays.reception(at_s(0), end_at(from, modem), end_at(to, modem)).paths.size();
  };
  ASSERT_GT(received(plain), 0u);
  EXPECT_LT(received(insensitive), received(plain));
}

TEST(Beams, TheLevelIsTheSumOfWeighedPathsAndTheBudgetFollows) {
  const acoustics::Modem beam = flat_looking(), plain;
  const Vec3 from(0, 0, 20), to(60, 0, 30);
  const Reception with = by_rays({}, end_at(from, beam), end_at(to, plain));
  EXPECT_NEAR(with.budget.received_level.value, total_level(with.paths).value, tolerance(1e-9));
  EXPECT_NEAR(with.budget.transmission_loss.value, 185 - with.budget.received_level.value, tolerance(1e-9));
  EXPECT_EQ(with.budget.noise_level.value,
            by_rays({}, end_at(from, plain), end_at(to, plain)).budget.noise_level.value);
}

TEST(Beams, BothWaysAreTheSameToTheLastBitWithThePatternsExchanged) {
  const acoustics::Modem one = flat_looking(), other = down_looking();
  const LinkEnd a{1, {0, 0, 20}, Vec3::Zero(), &one}, b{2, {60, 0, 70}, Vec3::Zero(), &other};
  for (const bool coherent : {false, true}) {
    RayModel model;
    model.coherent = coherent;
    RayPropagation rays(
        std::make_shared<EnvironmentTimeline>(even_water()),
        testing::seabed_around(a.position_ned_m, b.position_ned_m, [](double) { return 100; }), model);
    const Reception there = rays.reception(at_s(1), a, b), back = rays.reception(at_s(1), b, a);
    ASSERT_EQ(there.used, PropagationUsed::kRays);
    EXPECT_EQ(there.budget.received_level.value, back.budget.received_level.value) << coherent;
    ASSERT_EQ(there.paths.size(), back.paths.size());
    for (std::size_t i = 0; i < there.paths.size(); ++i) {
      EXPECT_EQ(there.paths[i].level.value, back.paths[i].level.value);
    }
  }
  EXPECT_EQ(by_line(a, b).budget.received_level.value, by_line(b, a).budget.received_level.value);
}

TEST(Beams, TheStraightPathIsWeighedInTheDirectionOfTheLine) {
  const acoustics::Modem beam = down_looking(), plain;
  const Vec3 high(0, 0, 10), low(100, 0, 90);
  const auto level = [](const LinkEnd& from, const LinkEnd& to) {
    const Reception reception = by_line(from, to);
    EXPECT_EQ(reception.paths.at(0).level.value, reception.budget.received_level.value);
    return reception.budget.received_level.value;
  };
  const double bare = level(end_at(high, plain), end_at(low, plain));
  EXPECT_EQ(level(end_at(high, beam), end_at(low, plain)), bare);
  EXPECT_EQ(level(end_at(low, plain), end_at(high, beam)), bare);
  EXPECT_NEAR(level(end_at(low, beam), end_at(high, plain)), bare - kDown20Db, tolerance(1e-9));
  EXPECT_NEAR(level(end_at(high, plain), end_at(low, beam)), bare - kDown20Db, tolerance(1e-9));
}

// 20 dB less of the sound or of the source: the same capacity.
TEST(Beams, CapacityFallsAsWithAWeakerSource) {
  acoustics::Modem plain, weak;
  weak.source_level = plain.source_level - Decibels{kDown20Db};
  const acoustics::Modem beam = down_looking();
  const Vec3 low(0, 0, 90), high(100, 0, 10);
  EXPECT_LT(relative_error(by_line(end_at(low, beam), end_at(high, plain)).budget.capacity_bps,
                           by_line(end_at(low, weak), end_at(high, plain)).budget.capacity_bps),
            tolerance(1e-12));
}

TEST(Beams, TwoModemsThatDifferInTheirBeamsAloneAreNotTakenForEachOther) {
  StraightPropagation straight(even_water());
  const acoustics::Modem beam = down_looking(), plain;
  const Vec3 low(0, 0, 90), high(100, 0, 10);
  const double bare = straight.reception(at_s(0), end_at(low, plain), end_at(high, plain)).budget.snr.value;
  EXPECT_NEAR(straight.reception(at_s(0), end_at(low, beam), end_at(high, plain)).budget.snr.value,
              bare - kDown20Db, tolerance(1e-9));
}

TEST(Beams, AnEchoOffTheBottomIsWeighedByBothWhereTheyLookDown) {
  const Vec3 from(0, 0, 50), to(100, 0, 50);
  const Vec3 middle(50, 0, 100);  // 45 degrees down
  const acoustics::Modem plain, beam = flat_looking();
  const auto level = [&](const acoustics::Modem& transmitter, const acoustics::Modem& receiver) {
    return echo_level(acoustics::LinkKernel(even_water(), transmitter, receiver), from, to, middle).value;
  };
  EXPECT_NEAR(level(beam, plain), level(plain, plain) - kDown20Db, tolerance(1e-9));
  EXPECT_NEAR(level(beam, beam), level(plain, plain) - 2 * kDown20Db, tolerance(1e-9));
}

}  // namespace
}  // namespace halocline::channel_server
