// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/vehicle_clocks.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "channel_server/vehicles/vehicle_id.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;

constexpr VehicleId kClockId = 3;
const SimDuration kFixLag = SimDuration::from_milliseconds(50);

VehicleClocks one_clock(const ClockSettings& settings, std::uint64_t seed = 1) {
  return {{{"auv", kClockId, settings}}, seed, kFixLag};
}

TEST(VehicleClocks, WithoutOneTheTimeIsRight) {
  EXPECT_EQ(VehicleClocks().error_s(kClockId, at_s(3600)), 0);
  EXPECT_EQ(one_clock({.offset_s = 1}).error_s(kClockId + 1, at_s(3600)), 0);
}

TEST(VehicleClocks, OnePartInAMillionGains3600MicrosecondsAnHour) {
  const VehicleClocks clocks = one_clock({.offset_s = 0.25, .drift = 1e-6});
  EXPECT_EQ(clocks.error_s(kClockId, at_s(0)), 0.25);
  EXPECT_NEAR(clocks.error_s(kClockId, at_s(3600)), 0.25 + 3.6e-3, tolerance(1e-15));
}

TEST(VehicleClocks, AFixSetsTheClockALagLaterAndTheDriftGoesOn) {
  VehicleClocks clocks = one_clock({.offset_s = 0.25, .drift = 1e-6, .gps_residual_s = 0});
  clocks.add_fix("auv", at_s(1000));
  EXPECT_NEAR(clocks.error_s(kClockId, at_s(1000.04)), 0.25 + 1.00004e-3, tolerance(1e-12));
  EXPECT_EQ(clocks.error_s(kClockId, at_s(1000.05)), 0);
  EXPECT_NEAR(clocks.error_s(kClockId, at_s(1100.05)), 1e-4, tolerance(1e-15));
}

TEST(VehicleClocks, FixesOfOthersAndWhereGpsDoesNotSetItChangeNothing) {
  VehicleClocks clocks = one_clock({.offset_s = 0.25, .is_set_by_gps = false});
  EXPECT_FALSE(clocks.need_fixes());
  clocks.add_fix("auv", at_s(10));
  EXPECT_EQ(clocks.error_s(kClockId, at_s(100)), 0.25);
  VehicleClocks other = one_clock({.offset_s = 0.25});
  EXPECT_TRUE(other.need_fixes());
  other.add_fix("buoy", at_s(10));
  EXPECT_EQ(other.error_s(kClockId, at_s(100)), 0.25);
}

TEST(VehicleClocks, TheOrderOfFixesAndWhatIsForgottenDoNotMatter) {
  const ClockSettings settings{.drift = 2e-6, .random_walk = 1e-7, .gps_residual_s = 1e-4};
  VehicleClocks forth = one_clock(settings), back = one_clock(settings);
  for (int i = 0; i < 20; ++i) {
    forth.add_fix("auv", at_s(100 * i));
    back.add_fix("auv", at_s(100 * (19 - i)));
  }
  back.forget_before(at_s(950));
  for (double t = 950; t < 3000; t += 33.3)
    EXPECT_EQ(forth.error_s(kClockId, at_s(t)), back.error_s(kClockId, at_s(t)));
}

// 2000 seeds: the relative standard error of a variance is sqrt(2 / 2000) = 3.2 %; bound at 4.
TEST(VehicleClocks, WhatGpsLeavesAndTheWalkHaveTheStatedDeviations) {
  constexpr int kSeeds = 2000;
  double residual = 0, walk = 0, joint = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    VehicleClocks clocks =
        one_clock({.random_walk = 1e-6, .gps_residual_s = 1e-5}, static_cast<std::uint64_t>(seed));
    clocks.add_fix("auv", at_s(500));
    const double set = clocks.error_s(kClockId, at_s(500.05)),
                 later = clocks.error_s(kClockId, at_s(900.05)) - set;
    residual += set * set / kSeeds;
    walk += later * later / kSeeds;
    joint += set * later / kSeeds;
  }
  const double bound = 4 * std::sqrt(2.0 / kSeeds);
  EXPECT_NEAR(residual / 1e-10, 1, bound);
  EXPECT_NEAR(walk / (1e-12 * 400), 1, bound);
  EXPECT_NEAR(joint / std::sqrt(1e-10 * 4e-10), 0, 4 / std::sqrt(kSeeds));
}

TEST(VehicleClocks, RefusesWhatNoClockDoes) {
  EXPECT_THROW(one_clock({.offset_s = 2e5}), InvalidArgument);
  EXPECT_THROW(one_clock({.drift = 0.01}), InvalidArgument);
  EXPECT_THROW(one_clock({.random_walk = -1}), InvalidArgument);
  EXPECT_THROW(one_clock({.gps_residual_s = -1}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::channel_server
