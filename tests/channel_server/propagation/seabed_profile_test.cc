// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/seabed_profile.h"

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;

// 100 m deep, samples every 100 m from -100 to 1600 m.
SeabedProfile level() { return {-100, 100, std::vector<double>(18, 100.0)}; }

TEST(SeabedProfile, DepthsCountFromTheSurface) {
  EXPECT_EQ(bottom_under(level(), {20, 30, 500}, -2.5).depth_at(250), 102.5);
}

TEST(SeabedProfile, UnderTheFirstEndBelowItTheBottomIsLoweredToJustBelowAndNowhereElse) {
  const auto bottom = bottom_under(level(), {103, 50, 1500}, 0);
  EXPECT_NEAR(bottom.depth_at(0), 103.1, tolerance(1e-12));
  EXPECT_EQ(bottom.depth_at(100), 100);
  EXPECT_EQ(bottom.depth_at(1500), 100);
}

TEST(SeabedProfile, UnderTheOtherEndItIsLoweredContinuouslyWhereverTheSamplesLie) {
  for (const double range_m : {840.0, 899.999, 900.0, 900.001, 999.9}) {
    const auto bottom = bottom_under(level(), {20, 104, range_m}, 0);
    EXPECT_NEAR(bottom.depth_at(range_m), 104.1, tolerance(1e-9)) << range_m;
    EXPECT_EQ(bottom.depth_at(700), 100);
    EXPECT_EQ(bottom.depth_at(1100), 100);
  }
  const auto before = bottom_under(level(), {20, 104, 899.999}, 0),
             after = bottom_under(level(), {20, 104, 900.001}, 0);
  for (const double range_m : {800.0, 850.0, 900.0, 950.0, 1000.0}) {
    EXPECT_NEAR(before.depth_at(range_m), after.depth_at(range_m), 1e-4) << range_m;
  }
}

TEST(SeabedProfile, LandIsTheLeastOfWater) {
  SeabedProfile island = level();
  island.z_m[9] = -40;
  EXPECT_NEAR(bottom_under(island, {20, 20, 1500}, 0).depth_at(800), 0.1, tolerance(1e-12));
}

TEST(SeabedProfile, OneEndRightAboveTheOtherHasTheBottomBelowBoth) {
  EXPECT_EQ(bottom_under(level(), {20, 60, 0}, 0).depth_at(0), 100);
  EXPECT_NEAR(bottom_under(level(), {20, 110, 0}, 0).depth_at(0), 110.1, tolerance(1e-12));
}

TEST(SeabedProfile, ARidgeCutsTheStraightLineWhenItReachesUpToIt) {
  SeabedProfile ridge = level();
  const acoustics::RayLink link{20, 80, 1500};  // the line is 40 m deep at 500 m
  ridge.z_m[6] = 41;
  EXPECT_FALSE(cuts_straight_line(bottom_under(ridge, link, 0), link));
  ridge.z_m[6] = 39;
  EXPECT_TRUE(cuts_straight_line(bottom_under(ridge, link, 0), link));
}

TEST(SeabedProfile, WhatRisesBeyondTheEndsCutsNoLine) {
  SeabedProfile wall = level();
  wall.z_m.front() = wall.z_m.back() = 1;
  const acoustics::RayLink link{20, 80, 1500};
  EXPECT_FALSE(cuts_straight_line(bottom_under(wall, link, 0), link));
}

}  // namespace
}  // namespace halocline::channel_server
