// SPDX-License-Identifier: BSD-3-Clause
#include "core/sim_time.h"

#include <gtest/gtest.h>

namespace halocline {
namespace {

TEST(SimTime, AMillionTenthsOfASecondAreExactlyAHundredThousandSeconds) {
  SimTime t;
  for (int i = 0; i < 1'000'000; ++i) t = t + SimDuration::from_seconds(0.1);
  EXPECT_EQ(t, SimTime::from_seconds(100'000));
}

TEST(SimTime, UtimeSurvivesTheRoundTripAndRoundsToNearest) {
  EXPECT_EQ(SimTime::from_utime(123'456'789).to_utime(), 123'456'789);
  EXPECT_EQ(SimTime::from_nanoseconds(1'499).to_utime(), 1);
  EXPECT_EQ(SimTime::from_nanoseconds(1'500).to_utime(), 2);
  EXPECT_EQ(SimTime::from_nanoseconds(-1'600).to_utime(), -2);
}

TEST(SimTime, TheNextGridInstantIsStrictlyLater) {
  const SimDuration period = SimDuration::from_milliseconds(100);
  EXPECT_EQ(next_on_grid(SimTime(), period), SimTime::from_utime(100'000));
  EXPECT_EQ(next_on_grid(SimTime::from_utime(99'999), period), SimTime::from_utime(100'000));
  EXPECT_EQ(next_on_grid(SimTime::from_utime(100'000), period), SimTime::from_utime(200'000));
  EXPECT_EQ(next_on_grid(SimTime::from_utime(-1), period), SimTime());
}

TEST(SimTime, NeverIsLaterAndAtOnceEarlierThanEveryInstant) {
  EXPECT_LT(SimTime::from_seconds(9e9), SimTime::never());
  EXPECT_GT(SimTime::from_seconds(-9e9), SimTime::at_once());
}

}  // namespace
}  // namespace halocline
