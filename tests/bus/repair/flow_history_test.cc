// SPDX-License-Identifier: BSD-3-Clause
#include "bus/repair/flow_history.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace halocline::bus {
namespace {

Bytes message_of(std::size_t size) { return Bytes(size, std::uint8_t{7}); }

TEST(FlowHistory, GivesBackTheBytesOfAMessage) {
  FlowHistory history(1000);
  history.keep("A", 1, 5, {1, 2, 3});
  ASSERT_NE(history.find("A", 1, 5), nullptr);
  EXPECT_EQ(*history.find("A", 1, 5), (Bytes{1, 2, 3}));
  EXPECT_EQ(history.find("A", 1, 4), nullptr);
  EXPECT_EQ(history.find("A", 2, 5), nullptr);
  EXPECT_EQ(history.find("B", 1, 5), nullptr);
}

TEST(FlowHistory, TheOldestMakeRoom) {
  FlowHistory history(100);
  for (std::int64_t i = 0; i < 20; ++i) history.keep(i % 2 == 0 ? "A" : "B", 1, i, message_of(10));
  for (std::int64_t i = 0; i < 20; ++i) {
    EXPECT_EQ(history.find(i % 2 == 0 ? "A" : "B", 1, i) != nullptr, i >= 10) << i;
  }
}

TEST(FlowHistory, AMessageBeyondTheBoundIsKeptAlone) {
  FlowHistory history(100);
  history.keep("A", 1, 0, message_of(10));
  history.keep("A", 1, 1, message_of(500));
  EXPECT_EQ(history.find("A", 1, 0), nullptr);
  EXPECT_NE(history.find("A", 1, 1), nullptr);
}

TEST(FlowHistory, OfOldMessagesTheLastOfEachFlowIsKept) {
  FlowHistory history(1 << 20);
  constexpr std::int64_t kAge = FlowHistory::kMaxAge.nanoseconds() / 1'000'000'000;
  history.keep("QUIET", 1, 4, {1, 2});
  for (std::int64_t t = 0; t < 10 * kAge; ++t) {  // ten messages a second
    for (std::int64_t i = 0; i < 10; ++i) history.keep("BUSY", 1, 10 * t + i, message_of(10));
    history.forget_old(SimTime::from_seconds(static_cast<double>(t)));
    for (const std::int64_t age : {std::int64_t{0}, kAge - 2}) {
      EXPECT_EQ(history.find("BUSY", 1, 10 * (t - age)) != nullptr, t >= age)
          << t << " s, of " << age << " s ago";
    }
    for (std::int64_t i = 0; i < 10; ++i)
      ASSERT_EQ(history.find("BUSY", 1, 10 * (t - kAge - 2) - i), nullptr) << t << " s, " << i;
    ASSERT_NE(history.find("QUIET", 1, 4), nullptr) << t;
  }
  EXPECT_EQ(*history.find("QUIET", 1, 4), (Bytes{1, 2}));
  ASSERT_EQ(history.last_messages().size(), 2u);
  EXPECT_EQ(*history.last_messages().front().message, (Bytes{1, 2}));
}

TEST(FlowHistory, TheLastMessageOfAFlowIsForgottenOnceItIsNotTheLast) {
  FlowHistory history(1 << 20);
  const auto at = [](int minutes) { return SimTime::from_seconds(60.0 * minutes); };
  history.keep("A", 1, 0, message_of(10));
  for (int minute = 0; minute < 6; ++minute) history.forget_old(at(minute));
  ASSERT_NE(history.find("A", 1, 0), nullptr);
  history.keep("A", 1, 1, message_of(10));
  for (int minute = 6; minute < 12; ++minute) history.forget_old(at(minute));
  EXPECT_EQ(history.find("A", 1, 0), nullptr);
  EXPECT_NE(history.find("A", 1, 1), nullptr);
}

TEST(FlowHistory, AForgottenFlowAndItsOldMessagesGoTogether) {
  FlowHistory history(1 << 20);
  history.keep("OLD", 1, 0, message_of(10));
  history.forget_old(SimTime::from_seconds(0));
  for (std::size_t i = 0; i < FlowHistory::kMaxFlows; ++i)
    history.keep("FLOW." + std::to_string(i), 1, 0, message_of(1));
  history.forget_old(SimTime::from_seconds(300));
  history.forget_old(SimTime::from_seconds(600));
  EXPECT_EQ(history.find("OLD", 1, 0), nullptr);
  EXPECT_EQ(history.num_flows(), FlowHistory::kMaxFlows);
}

TEST(FlowHistory, ListsTheLastNumberOfEachFlowEvenWhenItsMessagesAreGone) {
  FlowHistory history(10);
  history.keep("A", 1, 3, message_of(10));
  history.keep("B", 1, 9, message_of(10));
  history.keep("B", 1, 8, message_of(10));  // published again, out of its turn
  const auto flows = history.take_listing();
  ASSERT_EQ(flows.size(), 2u);
  EXPECT_EQ(flows[0].channel, "A");
  EXPECT_EQ(flows[0].last, 3);
  EXPECT_EQ(flows[1].last, 9);
}

TEST(FlowHistory, TheFlowsPublishedOnMostRecentlyAreKept) {
  FlowHistory history(1 << 20);
  constexpr std::int64_t kFlows = FlowHistory::kMaxFlows + 100;
  for (std::int64_t i = 0; i < kFlows; ++i) {
    history.keep("FLOW." + std::to_string(i), 1, 0, message_of(1));
    history.keep("BUSY", 1, i, message_of(1));
  }
  EXPECT_EQ(history.num_flows(), FlowHistory::kMaxFlows);
  EXPECT_NE(history.find("BUSY", 1, 0), nullptr);
  EXPECT_EQ(history.find("FLOW.5", 1, 0), nullptr);
  EXPECT_NE(history.find("FLOW." + std::to_string(kFlows - 1), 1, 0), nullptr);
}

std::set<std::string> channels_of(const std::vector<FlowHistory::Flow>& flows) {
  std::set<std::string> channels;
  for (const FlowHistory::Flow& flow : flows) channels.insert(flow.channel);
  return channels;
}

TEST(FlowHistory, OfManyFlowsThoseThatHaveBecomeSilentAreListedFirst) {
  FlowHistory history(1 << 20);
  constexpr int kFlows = 3 * FlowHistory::kMaxListed;
  for (int i = 0; i < kFlows; ++i) history.keep("FLOW." + std::to_string(i), 1, 0, message_of(1));
  EXPECT_TRUE(history.take_listing().empty());  // all have just been published on
  EXPECT_TRUE(channels_of(history.take_listing()).contains("FLOW.0"));
  history.keep("FLOW.1400", 1, 1, message_of(1));
  const auto busy = channels_of(history.take_listing());
  EXPECT_EQ(busy.size(), FlowHistory::kMaxListed);
  EXPECT_FALSE(busy.contains("FLOW.1400"));
  EXPECT_TRUE(channels_of(history.take_listing()).contains("FLOW.1400"));
}

TEST(FlowHistory, EachOfManyFlowsHasItsTurnToBeListed) {
  FlowHistory history(1 << 20);
  constexpr int kFlows = 3 * FlowHistory::kMaxListed;
  for (int i = 0; i < kFlows; ++i) history.keep("FLOW." + std::to_string(i), 1, i, message_of(1));
  EXPECT_TRUE(history.take_listing().empty());
  std::set<std::string> listed;
  for (int i = 0; i < 3; ++i) listed.merge(channels_of(history.take_listing()));
  EXPECT_EQ(listed.size(), kFlows);
}

TEST(FlowHistory, LastMessagesAreThoseOfTheFlowsPublishedOnSince) {
  FlowHistory history(1000);
  history.keep("A", 1, 1, {1});
  history.keep("B", 1, 1, {2});
  const auto published = history.published();
  history.keep("A", 1, 2, {3});
  const auto since = history.last_messages(published);
  ASSERT_EQ(since.size(), 1u);
  EXPECT_EQ(since[0].flow->channel, "A");
  EXPECT_EQ(*since[0].message, Bytes{3});
  EXPECT_EQ(history.last_messages().size(), 2u);
}

}  // namespace
}  // namespace halocline::bus
