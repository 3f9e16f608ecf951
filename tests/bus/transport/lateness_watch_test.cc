// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/lateness_watch.h"

#include <gtest/gtest.h>

#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using halocline::testing::at_ms;

SimDuration ms(std::int64_t milliseconds) { return SimDuration::from_milliseconds(milliseconds); }

TEST(LatenessWatch, WithoutResultsNothingIsLate) {
  LatenessWatch watch;
  const Lateness none = watch.summary(at_ms(5000));
  EXPECT_EQ(none.p50_s, 0);
  EXPECT_EQ(none.p99_s, 0);
  EXPECT_EQ(none.max_s, 0);
}

// 1, 2, ..., 1000 ms: the quantiles are 500 and 990 ms, and a bin is 9 % wide.
TEST(LatenessWatch, QuantilesAreTooGreatByABinAtMostAndTheGreatestIsExact) {
  LatenessWatch watch;
  for (int i = 1; i <= 1000; ++i) watch.add(at_ms(10 * i), ms(i));
  const Lateness lateness = watch.summary(at_ms(10'000));
  EXPECT_GE(lateness.p50_s, 0.500);
  EXPECT_LE(lateness.p50_s, 0.500 * 1.0906);
  EXPECT_GE(lateness.p99_s, 0.990);
  EXPECT_LE(lateness.p99_s, 1.0);
  EXPECT_EQ(lateness.max_s, 1.0);
}

TEST(LatenessWatch, OneInAHundredDoesNotMoveTheMedian) {
  LatenessWatch watch;
  for (int i = 0; i < 99; ++i) watch.add(at_ms(i), ms(0));
  watch.add(at_ms(99), ms(24'900));
  const Lateness lateness = watch.summary(at_ms(100));
  EXPECT_EQ(lateness.p50_s, 0);
  EXPECT_EQ(lateness.p99_s, 0);
  EXPECT_EQ(lateness.max_s, 24.9);
}

TEST(LatenessWatch, AMinuteLaterItIsForgotten) {
  LatenessWatch watch;
  watch.add(at_ms(1000), ms(700));
  EXPECT_EQ(watch.summary(at_ms(60'999)).max_s, 0.7);
  EXPECT_EQ(watch.summary(at_ms(61'000)).max_s, 0);
  watch.add(at_ms(61'500), ms(2));  // into the place of the first
  EXPECT_EQ(watch.summary(at_ms(61'600)).max_s, 0.002);
}

TEST(LatenessWatch, WithoutALimitNothingIsLateAndWithOneWhatIsBeyondIt) {
  LatenessWatch watch;
  EXPECT_FALSE(watch.note(at_ms(0), at_ms(0)));  // no clock
  watch.set_clock([] { return at_ms(1000); }, ms(0));
  EXPECT_FALSE(watch.note(at_ms(0), at_ms(100)));
  watch.set_clock([] { return at_ms(1000); }, ms(50));
  EXPECT_TRUE(watch.note(at_ms(0), at_ms(949)));
  EXPECT_FALSE(watch.note(at_ms(0), at_ms(950)));
  EXPECT_FALSE(watch.note(at_ms(0), at_ms(2000)));
  EXPECT_EQ(watch.summary(at_ms(1)).max_s, 0.9);
}

}  // namespace
}  // namespace halocline::bus
