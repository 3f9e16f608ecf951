// SPDX-License-Identifier: BSD-3-Clause
// Numbers that no publisher gave: one datagram, or a few, must not end the flow of another.
#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include "bus/repair/flow_watch.h"
#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using halocline::testing::at_ms;

// One datagram: a copy of the last message with the number 2^62.
TEST(FlowWatchForgery, ANumberFarAheadDoesNotEndItsFlow) {
  FlowWatch watch;
  watch.on_last(SimTime(), "A", 1, 0, {});
  for (int i = 0; i < 10; ++i) watch.on_message(SimTime(), "A", 1, i);
  watch.on_message(SimTime(), "A", 1, std::int64_t{1} << 62);
  for (int i = 10; i < 100; ++i) {
    const auto arrival = watch.on_message(at_ms(100 * i), "A", 1, i);
    EXPECT_FALSE(arrival.is_repeated) << i;
    EXPECT_EQ(arrival.newly_missing, 0) << i;
  }
  EXPECT_EQ(watch.lost(), 0);
}

// As far as repair reaches: what lies between is missing, expires, and is received when it comes.
TEST(FlowWatchForgery, ANumberAheadDoesNotEndItsFlow) {
  for (const int ahead : {2, 60, 1500}) {
    FlowWatch watch;
    watch.on_last(SimTime(), "A", 1, 0, {});
    watch.on_message(SimTime(), "A", 1, 0);
    watch.on_message(SimTime(), "A", 1, ahead);
    for (int i = 1; i < ahead; ++i) {
      watch.take_due(at_ms(1000 * i));
      EXPECT_FALSE(watch.on_message(at_ms(1000 * i), "A", 1, i).is_repeated) << ahead << ' ' << i;
    }
    EXPECT_EQ(watch.on_message(at_ms(1000 * ahead), "A", 1, ahead + 1).newly_missing, 0) << ahead;
  }
}

TEST(FlowWatchForgery, ALeapThatTheNextMessageConfirmsIsFollowed) {
  FlowWatch watch;
  for (const int i : {0, 1, 50'000}) watch.on_message(SimTime(), "A", 1, i);
  const auto confirming = watch.on_message(SimTime(), "A", 1, 50'001);
  EXPECT_EQ(confirming.newly_missing, 49'999);
  EXPECT_FALSE(watch.on_message(SimTime(), "A", 1, 50'002).is_repeated);
  for (const FlowWatch::Request& request : watch.take_due(at_ms(5)))
    EXPECT_EQ(std::count(request.sequences.begin(), request.sequences.end(), 50'000), 0);
}

// Three heartbeats of a stranger, under its own name, list the flow of another.
TEST(FlowWatchForgery, HeartbeatsOfAStrangerDoNotEndAFlow) {
  constexpr std::uint64_t kStranger = 987'654'321;
  for (const std::int64_t ahead : {1500LL, 100'000LL, 1LL << 62}) {
    FlowWatch watch;
    for (int i = 0; i < 100; ++i) {
      const SimTime now = at_ms(100 * i);
      if (i > 0) watch.on_last(now, "A", 1, i - 1, {.node = 1});
      if (i > 10 && i < 14) watch.on_last(now, "A", 1, i + ahead, {.node = kStranger});
      EXPECT_FALSE(watch.on_message(now, "A", 1, i).is_repeated) << ahead << ' ' << i;
    }
    EXPECT_EQ(watch.num_missing(), 0u);
  }
}

// Of a flow that has no lister yet, or of which nothing was received.
TEST(FlowWatchForgery, AFlowThatAStrangerListedFirstIsReceived) {
  for (const bool is_heard : {false, true}) {
    FlowWatch watch;
    if (is_heard) watch.on_message(SimTime(), "A", 1, 0);
    for (int i = 0; i < 3; ++i)
      watch.on_last(at_ms(300 * i), "A", 1, std::int64_t{1} << 62, {.node = 9, .from_its_start = true});
    for (int i = 1; i < 100; ++i)
      EXPECT_FALSE(watch.on_message(at_ms(1000 + 100 * i), "A", 1, i).is_repeated) << is_heard << ' ' << i;
  }
}

TEST(FlowWatchForgery, TwoMessagesFarAheadThatGoOnFromEachOtherDoNotEndAFlow) {
  FlowWatch watch;
  watch.on_last(SimTime(), "A", 1, 0, {});
  for (const int i : {0, 1, 2, 1'000'000, 1'000'001}) watch.on_message(SimTime(), "A", 1, i);
  for (int i = 3; i < 100; ++i) {
    watch.take_due(at_ms(1000 * i));
    EXPECT_FALSE(watch.on_message(at_ms(1000 * i), "A", 1, i).is_repeated) << i;
    EXPECT_TRUE(watch.on_message(at_ms(1000 * i), "A", 1, i).is_repeated) << i;
  }
}

}  // namespace
}  // namespace halocline::bus
