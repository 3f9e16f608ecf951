#include "bus/flow_history.h"

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

TEST(FlowHistory, ListsTheLastNumberOfEachFlowEvenWhenItsMessagesAreGone) {
  FlowHistory history(10);
  history.keep("A", 1, 3, message_of(10));
  history.keep("B", 1, 9, message_of(10));
  history.keep("B", 1, 8, message_of(10));  // published again, out of its turn
  const auto flows = history.flows();
  ASSERT_EQ(flows.size(), 2u);
  EXPECT_EQ(flows[0].channel, "A");
  EXPECT_EQ(flows[0].last, 3);
  EXPECT_EQ(flows[1].last, 9);
}

TEST(FlowHistory, TheFlowsPublishedOnMostRecentlyAreKept) {
  FlowHistory history(1 << 20);
  for (std::int64_t i = 0; i < 600; ++i) {
    history.keep("FLOW." + std::to_string(i), 1, 0, message_of(1));
    history.keep("BUSY", 1, i, message_of(1));
  }
  EXPECT_EQ(history.flows().size(), FlowHistory::kMaxFlows);
  EXPECT_NE(history.find("BUSY", 1, 0), nullptr);
  EXPECT_EQ(history.find("FLOW.5", 1, 0), nullptr);
  EXPECT_NE(history.find("FLOW.599", 1, 0), nullptr);
}

}  // namespace
}  // namespace halocline::bus
