// SPDX-License-Identifier: BSD-3-Clause
#include "bus/repair/flow_watch.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using halocline::testing::at_ms;

class FlowWatchTest : public ::testing::Test {
 protected:
  // How many messages are missing before this one, received at 0.
  std::int64_t missing_before(const char* channel, std::int64_t session, std::int64_t sequence) {
    return watch_.on_message(SimTime(), channel, session, sequence).newly_missing;
  }
  void receive(std::initializer_list<std::int64_t> sequences) {
    for (const std::int64_t sequence : sequences) watch_.on_message(SimTime(), "A", 1, sequence);
  }
  // The sequence numbers requested at this instant, of the only flow.
  std::vector<std::int64_t> requested_at(SimTime steady) {
    const auto requests = watch_.take_due(steady);
    return requests.empty() ? std::vector<std::int64_t>() : requests.front().sequences;
  }

  FlowWatch watch_;
};

TEST_F(FlowWatchTest, TheFirstAndTheNextMissNothing) {
  EXPECT_EQ(missing_before("A", 1, 40), 0);
  EXPECT_EQ(missing_before("A", 1, 41), 0);
  EXPECT_EQ(watch_.next_due(), SimTime::never());
}

TEST_F(FlowWatchTest, AGapIsCountedOnce) {
  missing_before("A", 1, 0);
  EXPECT_EQ(missing_before("A", 1, 5), 4);
  EXPECT_EQ(missing_before("A", 1, 6), 0);
}

TEST_F(FlowWatchTest, DuplicatesAndReorderedMessagesAreNoGaps) {
  missing_before("A", 1, 5);
  EXPECT_EQ(missing_before("A", 1, 5), 0);
  EXPECT_EQ(missing_before("A", 1, 4), 0);
  EXPECT_EQ(missing_before("A", 1, 6), 0);
}

TEST_F(FlowWatchTest, MessagesBetweenTheFirstReceivedAndAReorderedOneAreMissing) {
  missing_before("A", 1, 5);
  EXPECT_EQ(missing_before("A", 1, 2), 2);
  EXPECT_THAT(requested_at(at_ms(5)), ElementsAre(3, 4));
}

TEST_F(FlowWatchTest, ANewSessionStartsAnew) {
  missing_before("A", 1, 100);
  EXPECT_EQ(missing_before("A", 2, 0), 0);
  EXPECT_EQ(missing_before("A", 2, 2), 1);
}

TEST_F(FlowWatchTest, TwoPublishersOnOneChannelAreTrackedApart) {
  missing_before("A", 1, 0);
  missing_before("A", 2, 50);
  EXPECT_EQ(missing_before("A", 1, 1), 0);
  EXPECT_EQ(missing_before("A", 2, 52), 1);
}

TEST_F(FlowWatchTest, ChannelsAreTrackedApart) {
  missing_before("A", 1, 0);
  missing_before("B", 1, 10);
  EXPECT_EQ(missing_before("A", 1, 1), 0);
}

TEST_F(FlowWatchTest, APublisherWithoutSequenceNumbersIsNotWatched) {
  for (int i = 0; i < 3; ++i) {
    const auto arrival = watch_.on_message(SimTime(), "A", 0, 0);
    EXPECT_EQ(arrival.newly_missing, 0);
    EXPECT_FALSE(arrival.is_repeated);
  }
}

TEST_F(FlowWatchTest, KeepsTheSessionReceivedLastAmongMany) {
  missing_before("A", 1, 0);  // the smallest number of all, but received repeatedly
  for (int session = 100; session < 130; ++session) {
    missing_before("A", 1, session - 99);
    missing_before("A", session, 0);
  }
  EXPECT_EQ(missing_before("A", 1, 35), 4);
}

// As many as shards that share OUTCOME.
TEST_F(FlowWatchTest, SeventySessionsOfOneChannelAreTrackedWhileAllAreHeard) {
  for (int sequence = 0; sequence < 100; sequence += 2) {
    for (int session = 1; session <= 70; ++session) {
      const auto arrival = watch_.on_message(at_ms(1000 * sequence), "A", session, sequence);
      EXPECT_EQ(arrival.newly_missing, sequence > 0 ? 1 : 0);
    }
  }
}

// A program that is started again every minute has four sessions that are known, and one that is silent for
// less than half of one is remembered whatever follows it.
TEST_F(FlowWatchTest, SessionsThatAreSilentForLongAreForgotten) {
  for (int session = 1; session <= 100; ++session)
    watch_.on_message(at_ms(60'000 * session), "A", session, 5);
  const SimTime now = at_ms(60'000 * 100 + 1000);
  for (int session = 97; session <= 100; ++session)
    EXPECT_TRUE(watch_.on_message(now, "A", session, 5, true).is_repeated);
  EXPECT_EQ(watch_.num_flows(), 4u);
  for (int session = 101; session <= 110; ++session) watch_.on_message(now, "A", session, 5);
  EXPECT_EQ(watch_.num_flows(), 11u);
}

TEST_F(FlowWatchTest, HostileSequenceNumbersNeitherOverflowNorGrow) {
  missing_before("A", 1, INT64_MIN);
  EXPECT_EQ(missing_before("A", 1, INT64_MAX - 1), 0);
  EXPECT_GT(missing_before("A", 1, INT64_MAX), 0);
  EXPECT_EQ(missing_before("A", 1, INT64_MIN), 0);
  EXPECT_GT(watch_.lost(), 0);
  EXPECT_LE(requested_at(at_ms(5)).size(), FlowWatch::kMaxPerRequest);
}

// 500 flows with 2^62 messages each: what one legal datagram of 17 kB can claim.
TEST_F(FlowWatchTest, WhatAHeartbeatClaimsOfFlowsNeverHeardTakesNoMoreThanItsBound) {
  for (int datagram = 0; datagram < 11; ++datagram) {
    for (int flow = 0; flow < 500; ++flow) {
      const std::string channel = "STATE.v" + std::to_string(500 * datagram + flow);
      EXPECT_GT(watch_.on_last(SimTime(), channel, 1, std::int64_t{1} << 62, {.from_its_start = true}), 0);
    }
  }
  EXPECT_EQ(watch_.num_missing(), FlowWatch::kMaxMissingUnheard);
  missing_before("A", 1, 0);
  EXPECT_EQ(missing_before("A", 1, 11), 10);
  EXPECT_EQ(watch_.num_missing(), FlowWatch::kMaxMissingUnheard + 10);
  EXPECT_GT(watch_.lost(), 0);
  watch_.take_due(at_ms(20'000));
  EXPECT_EQ(watch_.num_missing(), 0u);
}

TEST_F(FlowWatchTest, OneBoundHoldsForTheMissingMessagesOfAllFlows) {
  for (int flow = 0; flow < 100; ++flow) {
    const std::string channel = "C" + std::to_string(flow);
    watch_.on_message(SimTime(), channel, 1, 0);
    watch_.on_message(SimTime(), channel, 1, 1 + FlowWatch::kMaxMissing);
  }
  EXPECT_EQ(watch_.num_missing(), FlowWatch::kMaxMissingOfAll);
}

TEST_F(FlowWatchTest, CountersSaturate) {
  for (int i = 0; i < 10; ++i) {
    watch_.on_last(SimTime(), "A" + std::to_string(i), 1, INT64_MAX - 1, {.from_its_start = true});
    EXPECT_GT(watch_.lost(), 0);
  }
  EXPECT_EQ(watch_.lost(), INT64_MAX);
  EXPECT_EQ(saturating_sum(INT64_MAX, 1), INT64_MAX);
  EXPECT_EQ(saturating_sum(2, 3), 5);
}

TEST_F(FlowWatchTest, ChannelsBeyondABoundAreNotWatched) {
  for (std::size_t i = 0; i < FlowWatch::kMaxChannels + 10; ++i) {
    const std::string channel = "C" + std::to_string(i);
    watch_.on_message(SimTime(), channel, 1, 0);
    const auto arrival = watch_.on_message(SimTime(), channel, 1, 2);
    EXPECT_EQ(arrival.newly_missing, i < FlowWatch::kMaxChannels ? 1 : 0);
  }
}

TEST_F(FlowWatchTest, MissingMessagesAreRequestedAfterTheReorderingDelay) {
  receive({0, 3});
  EXPECT_EQ(watch_.next_due(), at_ms(5));
  EXPECT_THAT(requested_at(at_ms(4)), IsEmpty());
  EXPECT_THAT(requested_at(at_ms(5)), ElementsAre(1, 2));
}

TEST_F(FlowWatchTest, ReorderedMessagesAreNotRequested) {
  receive({0, 2, 1});
  EXPECT_THAT(requested_at(at_ms(5)), IsEmpty());
}

TEST_F(FlowWatchTest, RequestsAreRepeatedAtGrowingIntervals) {
  receive({0, 2});
  std::vector<std::int64_t> requested_ms;
  for (std::int64_t ms = 0; ms < 3000; ++ms) {
    if (!requested_at(at_ms(ms)).empty()) requested_ms.push_back(ms);
  }
  EXPECT_THAT(requested_ms, ElementsAre(5, 45, 125, 285, 605, 1245, 1885, 2525));
}

TEST_F(FlowWatchTest, AMessageThatFillsAGapEndsTheRequests) {
  receive({0, 2});
  EXPECT_TRUE(watch_.on_message(at_ms(6), "A", 1, 1).fills_gap);
  EXPECT_THAT(requested_at(at_ms(100)), IsEmpty());
  EXPECT_FALSE(watch_.on_message(at_ms(7), "A", 1, 1).fills_gap);
}

TEST_F(FlowWatchTest, AnUnansweredRequestExpiresAfterTenSeconds) {
  receive({0, 4});
  watch_.take_due(at_ms(9'999));
  EXPECT_EQ(watch_.lost(), 0);
  watch_.take_due(at_ms(10'000));
  EXPECT_EQ(watch_.lost(), 3);
  EXPECT_EQ(watch_.next_due(), SimTime::never());
}

TEST_F(FlowWatchTest, AMessageReceivedTwiceIsADuplicate) {
  receive({0, 1, 2});
  EXPECT_TRUE(watch_.on_message(at_ms(1), "A", 1, 2).is_repeated);
  EXPECT_TRUE(watch_.on_message(at_ms(1), "A", 1, 0).is_repeated);
  EXPECT_FALSE(watch_.on_message(at_ms(1), "A", 1, 3).is_repeated);
}

TEST_F(FlowWatchTest, APublisherThatRestartsItsSequenceAfterASilenceIsReceived) {
  receive({0, 1, 2, 3});
  EXPECT_FALSE(watch_.on_message(at_ms(2000), "A", 1, 0, false, 2'000'000).is_repeated);
}

// An exact copy has the time of the original, so it is no new beginning of a publisher without heartbeats.
TEST_F(FlowWatchTest, AnOldMessageOfAFlowThatNobodyListsIsADuplicateHoweverOld) {
  const auto utime = [](std::int64_t sequence) { return 100'000 * sequence; };
  for (std::int64_t i = 0; i < 100; ++i) watch_.on_message(at_ms(100 * i), "A", 1, i, false, utime(i));
  for (const std::int64_t old : {0, 9, 50, 98, 99}) {
    EXPECT_TRUE(watch_.is_old(at_ms(19'000), "A", 1, old, utime(old))) << old;
    EXPECT_TRUE(watch_.on_message(at_ms(19'000), "A", 1, old, false, utime(old)).is_repeated) << old;
  }
  EXPECT_FALSE(watch_.is_old(at_ms(20'000), "A", 1, 100, utime(100)));
  const auto next = watch_.on_message(at_ms(20'000), "A", 1, 100, false, utime(100));
  EXPECT_FALSE(next.is_repeated);
  EXPECT_EQ(next.newly_missing, 0);
}

TEST_F(FlowWatchTest, WhatIsMissingOrExpiredIsNotOld) {
  watch_.on_message(SimTime(), "A", 1, 0, false, 0);
  watch_.on_message(SimTime(), "A", 1, 3, false, 300);
  EXPECT_FALSE(watch_.is_old(at_ms(1), "A", 1, 1, 100));
  watch_.take_due(at_ms(10'000));
  EXPECT_FALSE(watch_.is_old(at_ms(10'001), "A", 1, 2, 200));
  EXPECT_FALSE(watch_.is_old(at_ms(10'001), "B", 1, 0, 0));
}

// A datagram that the network delivers again much later, or that somebody replays: without the heartbeat it
// would be a new start, after which all that followed is missing, repaired and handled a second time.
TEST_F(FlowWatchTest, AnOldDuplicateOfAFlowThatAHeartbeatListsIsIgnored) {
  for (std::int64_t sequence = 0; sequence <= 200; ++sequence) receive({sequence});
  watch_.on_last(SimTime(), "A", 1, 200, {.from_its_start = true});
  EXPECT_TRUE(watch_.on_message(at_ms(1), "A", 1, 100, false).is_repeated);
  EXPECT_TRUE(watch_.on_message(at_ms(1500), "A", 1, 200, false).is_repeated);
  EXPECT_TRUE(watch_.on_message(at_ms(60'000), "A", 1, 0, false).is_repeated);
  EXPECT_EQ(watch_.on_last(at_ms(60'001), "A", 1, 200, {.from_its_start = true}), 0);
  EXPECT_EQ(watch_.on_message(at_ms(60'002), "A", 1, 201, false).newly_missing, 0);
}

TEST_F(FlowWatchTest, ALostTailShowsInTheLastNumberOfTheHeartbeat) {
  receive({0, 1});
  EXPECT_EQ(watch_.on_last(SimTime(), "A", 1, 3, {}), 2);
  EXPECT_EQ(watch_.on_last(SimTime(), "A", 1, 3, {}), 0);
  EXPECT_THAT(requested_at(at_ms(5)), ElementsAre(2, 3));
}

TEST_F(FlowWatchTest, MessagesBeforeTheReceiverStartedAreNotMissing) {
  EXPECT_EQ(watch_.on_last(SimTime(), "A", 1, 7, {}), 0);
  EXPECT_EQ(watch_.on_last(SimTime(), "A", 1, 8, {}), 1);
  EXPECT_THAT(requested_at(at_ms(5)), ElementsAre(8));
}

TEST_F(FlowWatchTest, ARepairThatFillsNoGapIsADuplicate) {
  receive({0, 2});
  EXPECT_FALSE(watch_.on_message(SimTime(), "A", 1, 1, true).is_repeated);
  EXPECT_TRUE(watch_.on_message(SimTime(), "A", 1, 1, true).is_repeated);
  EXPECT_TRUE(watch_.on_message(SimTime(), "B", 1, 1, true).is_repeated);
}

TEST_F(FlowWatchTest, AFlowNewerThanAHeartbeatIsExpectedFromItsStart) {
  watch_.on_all_listed(1);
  EXPECT_EQ(missing_before("A", 1, 2), 2);
  EXPECT_THAT(requested_at(at_ms(5)), ElementsAre(0, 1));
}

// A node publishes for others, under their sessions.
TEST_F(FlowWatchTest, AFlowOfAnotherSessionThatAHeartbeatListsForTheFirstTimeIsExpectedFromItsStart) {
  for (const bool was_received : {false, true}) {
    FlowWatch watch;
    watch.on_all_listed(50);
    if (was_received) watch.on_message(SimTime(), "A", 1, 2);
    EXPECT_EQ(watch.on_last(SimTime(), "A", 1, 2, {.session = 50}), was_received ? 2 : 3);
    EXPECT_EQ(watch.on_last(SimTime(), "A", 1, 2, {.session = 50}), 0) << "once";
  }
  FlowWatch watch;
  EXPECT_EQ(watch.on_last(SimTime(), "A", 1, 2, {.session = 50}), 0);
  watch.on_all_listed(50);
  EXPECT_EQ(watch.on_last(SimTime(), "A", 1, 2, {.session = 50}), 0) << "it had listed it before";
}

TEST_F(FlowWatchTest, SoItIsAmongTheHeartbeatsOfThreeThousandNodes) {
  for (std::int64_t session = 1; session <= 3000; ++session) watch_.on_all_listed(session);
  EXPECT_EQ(missing_before("A", 1, 2), 2);
}

TEST_F(FlowWatchTest, AReceiverOlderThanThePublisherMissesMessagesBeforeTheFirstReceived) {
  receive({3});
  EXPECT_EQ(watch_.on_last(SimTime(), "A", 1, 3, {.from_its_start = true}), 3);
  EXPECT_THAT(requested_at(at_ms(5)), ElementsAre(0, 1, 2));
}

TEST_F(FlowWatchTest, AnAnnouncedFlowOfWhichNothingWasReceivedIsMissingWhole) {
  EXPECT_EQ(watch_.on_last(SimTime(), "A", 1, 2, {.from_its_start = true}), 3);
  EXPECT_THAT(requested_at(at_ms(5)), ElementsAre(0, 1, 2));
}

TEST_F(FlowWatchTest, EverySequenceNumberIsReceivedOrLostWhateverTheOrder) {
  // A sweep through all orders of a short flow, each with every subset of it delivered: gaps found, filled
  // and lost always balance.
  std::vector<std::int64_t> order{0, 1, 2, 3};
  do {
    for (unsigned delivered = 0; delivered < 16; ++delivered) {
      FlowWatch watch;
      std::int64_t missing = 0, filled = 0;
      watch.on_message(SimTime(), "A", 1, -1);
      for (const std::int64_t sequence : order) {
        if ((delivered >> sequence & 1u) == 0) continue;
        const auto arrival = watch.on_message(SimTime(), "A", 1, sequence);
        missing += arrival.newly_missing;
        filled += arrival.fills_gap ? 1 : 0;
      }
      missing += watch.on_last(SimTime(), "A", 1, 3, {});
      watch.take_due(at_ms(20'000));
      EXPECT_EQ(missing - filled, watch.lost());
      EXPECT_EQ(watch.lost(), 4 - __builtin_popcount(delivered));
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

}  // namespace
}  // namespace halocline::bus
