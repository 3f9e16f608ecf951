// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lateness_watch.h"

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

TEST(LatenessWatch, ResultsAreWhatIsDueAtItsUtime) {
  for (const char* channel :
       {"OUTCOME", "CLOCK", "STATE.auv-1", "RECEIPT.auv-1", "LINKS.auv-1", "COMMAND.auv-1"})
    EXPECT_TRUE(LatenessWatch::is_result(channel)) << channel;
  for (const char* channel : {"SEND.auv-1", "SET_ENVIRONMENT", "FAULT.auv-1", "STATUS.traffic",
                              "HEARTBEAT.traffic", "REPAIR.STATE.auv-1", "REPAIR_REQUEST"})
    EXPECT_FALSE(LatenessWatch::is_result(channel)) << channel;
}

}  // namespace
}  // namespace halocline::bus
