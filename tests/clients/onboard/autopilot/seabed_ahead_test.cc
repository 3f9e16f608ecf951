// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/seabed_ahead.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

const double kSeabedAheadRounding = tolerance(1e-9);

// A vehicle goes north at z over a seabed of z = depth + slope * north, and looks every 0.4 m.
SeabedAhead over_slope(double z, double depth, double slope, double pitch, double until_m) {
  SeabedAhead seabed;
  for (int i = 0; i * 0.4 <= until_m; ++i) {
    const double x = 0.4 * i;
    // The beam points `pitch` ahead of straight down: z + a cos = depth + slope (x + a sin).
    const double a = (depth + slope * x - z) / (std::cos(pitch) - slope * std::sin(pitch));
    seabed.add({0.2 * i, {x, 0, z}, {0, pitch, 0}, true, a});
  }
  return seabed;
}

TEST(SeabedAhead, PlaneIsSeenAsItIsAtAnyPitch) {
  for (const double pitch : {-0.3, 0.0, 0.3}) {
    const auto line = over_slope(10, 20, 0.1, pitch, 40).line(20);
    ASSERT_TRUE(line);
    EXPECT_NEAR(line->slope, 0.1, kSeabedAheadRounding) << pitch;
    EXPECT_NEAR(line->z_ned_m, 20 + 0.1 * 40, kSeabedAheadRounding) << pitch;
  }
}

TEST(SeabedAhead, RollDoesNotDeepenTheSeabed) {
  SeabedAhead seabed;
  seabed.add({0, {0, 0, 10}, {0.5, 0, 0}, true, 10 / std::cos(0.5)});
  EXPECT_NEAR(seabed.line(0)->z_ned_m, 20, kSeabedAheadRounding);
}

TEST(SeabedAhead, StandingStillDeterminesNoSlope) {
  SeabedAhead seabed;
  for (int i = 0; i < 50; ++i) seabed.add({0.2 * i, {0, 0, 10}, {}, true, 10 + 0.01 * (i % 2)});
  EXPECT_EQ(seabed.line(10)->slope, 0);
}

TEST(SeabedAhead, OldEchoesAreNoSeabed) {
  SeabedAhead seabed;
  seabed.add({0, {0, 0, 10}, {}, true, 10});
  EXPECT_TRUE(seabed.line(SeabedAhead::kOldestS));
  EXPECT_FALSE(seabed.line(SeabedAhead::kOldestS + 0.1));
}

TEST(AboveSeabed, KeepsTheHeightAlongASlopeThatFallsAway) {
  const SetPoints points =
      above_seabed({3, 4}, over_slope(10, 20, 0.1, 0, 40), 20, 10, {.altitude_m = 5, .max_z_ned_m = 1e3});
  EXPECT_NEAR(points.z_ned_m, 20 + 4 - 5, kSeabedAheadRounding);
  EXPECT_NEAR(points.climb_rad, -std::atan(0.1), kSeabedAheadRounding);
}

TEST(AboveSeabed, ClimbsBeforeASeabedThatRises) {
  const SetPoints points =
      above_seabed({3, 4}, over_slope(0, 20, -0.2, 0, 40), 20, 0, {.altitude_m = 5, .max_z_ned_m = 1e3});
  EXPECT_NEAR(points.z_ned_m, 20 - 0.2 * 44 - 5, kSeabedAheadRounding);  // that of the seabed 4 m ahead
  EXPECT_NEAR(points.climb_rad, std::atan(0.2), kSeabedAheadRounding);
}

TEST(AboveSeabed, DepthIsLeftAloneHighAboveTheSeabed) {
  const SetPoints points = above_seabed({3, 4}, over_slope(10, 50, 0.1, 0, 40), 20, 10, {.z_ned_m = 25});
  EXPECT_EQ(points.z_ned_m, 25);
  EXPECT_EQ(points.climb_rad, 0);
}

TEST(AboveSeabed, DepthBelowTheLeastHeightIsCut) {
  EXPECT_NEAR(above_seabed({3, 4}, over_slope(10, 20, 0, 0, 40), 20, 10, {.z_ned_m = 25}).z_ned_m, 17,
              kSeabedAheadRounding);
}

TEST(AboveSeabed, BelowTheLeastHeightTheVehicleIsPulledUp) {
  const SetPoints points = above_seabed({3, 4}, over_slope(18, 20, 0, 0, 40), 20, 18, {.z_ned_m = 25});
  EXPECT_NEAR(points.z_ned_m, 17, kSeabedAheadRounding);
  EXPECT_GT(points.climb_rad, 0.2);
}

TEST(AboveSeabed, GoesDownWhereNoBottomIsSeenButNotForEver) {
  SeabedAhead seabed;
  seabed.add({0, {0, 0, 10}, {}, false, 0});
  EXPECT_GT(above_seabed({3, 4}, seabed, 0, 10, {.altitude_m = 5, .max_z_ned_m = 1e3}).z_ned_m, 10);
  EXPECT_EQ(above_seabed({3, 4}, seabed, 0, 10, {.altitude_m = 5, .max_z_ned_m = 11}).z_ned_m, 11);
}

TEST(AboveSeabed, WithoutAnAltimeterTheHeightIsNotGuessed) {
  EXPECT_EQ(above_seabed({3, 4}, {}, 0, 10, {.altitude_m = 5, .max_z_ned_m = 1e3}).z_ned_m, 10);
}

}  // namespace
}  // namespace halocline::clients
