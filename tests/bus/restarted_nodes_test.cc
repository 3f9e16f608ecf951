// SPDX-License-Identifier: BSD-3-Clause
// Nodes that publish, or receive, from later on. A process that was killed and started again is, as a
// publisher, a duplicate of the one before for a second, and its messages are refused (session_watch.h): what
// it published meanwhile is repaired. As a receiver it goes on with the flows that the one before knew. What
// was published before a subscription is not missing.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "bus/repair/flow_repair.h"
#include "bus/repair/flow_watch.h"
#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using halocline::testing::at_ms;

constexpr std::int64_t kRestarted = 7;

flow_heartbeat_t heartbeat_of(std::int64_t sequence) {
  flow_heartbeat_t heartbeat{};
  heartbeat.session = kRestarted;
  heartbeat.sequence = sequence;
  heartbeat.age_us = 100'000'000'000'000;  // as of one that resumes from a journal
  return heartbeat;
}

// One that lists a flow.
flow_heartbeat_t listing(const std::string& channel, std::int64_t last) {
  flow_heartbeat_t heartbeat = heartbeat_of(40);
  heartbeat.num_flows = heartbeat.num_flows_kept = 1;
  heartbeat.flow_channel = {channel};
  heartbeat.flow_session = {kRestarted};
  heartbeat.flow_last_sequence = {last};
  return heartbeat;
}

TEST(RestartedPublisher, AFlowThatBeganWhileItWasADuplicateIsRequestedWhole) {
  for (const int duplicate_heartbeats : {1, 2, 3}) {
    FlowWatch watch;
    FlowRepair receiver("receiver", 1, watch);
    receiver.take_heartbeat(SimTime(), at_ms(0));
    const auto none = [](std::string_view) { return false; };
    const auto all = [](std::string_view) { return true; };
    for (int i = 0; i < duplicate_heartbeats; ++i)
      EXPECT_EQ(receiver.on_heartbeat(at_ms(10'000 + 250 * i), "publisher", heartbeat_of(i), none), 0);
    const flow_heartbeat_t accepted = listing("RECEIVE.auv-7", 2);
    EXPECT_EQ(receiver.on_heartbeat(at_ms(11'000), "publisher", accepted, all), 3) << duplicate_heartbeats;
    const auto requests = receiver.take_requests(SimTime(), at_ms(11'010));
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].missing_sequence, (std::vector<std::int64_t>{0, 1, 2}));
  }
}

// Its heartbeats have another session than the flow, which goes on.
TEST(RestartedPublisher, WhatFollowsInItsFlowsIsRequestedAtOnce) {
  FlowWatch watch;
  FlowRepair receiver("receiver", 1, watch);
  receiver.take_heartbeat(SimTime(), at_ms(0));
  const auto all = [](std::string_view) { return true; };
  watch.on_message(at_ms(10'000), "RECEIVE.auv-7", kRestarted, 0);
  flow_heartbeat_t heartbeat = listing("RECEIVE.auv-7", 0);
  EXPECT_EQ(receiver.on_heartbeat(at_ms(10'010), "channel-server-0", heartbeat, all), 0);
  heartbeat.session = 8;
  heartbeat.flow_last_sequence = {1};
  EXPECT_EQ(receiver.on_heartbeat(at_ms(11'010), "channel-server-0", heartbeat, all), 1);
}

// A receiver that has been there for longer than the publisher, and heard its heartbeats.
TEST(LaterSubscription, MissesNothingOfWhatWasPublishedBefore) {
  for (const bool is_subscribed_later : {false, true}) {
    FlowWatch watch;
    FlowRepair receiver("receiver", 1, watch);
    receiver.take_heartbeat(SimTime(), at_ms(0));
    flow_heartbeat_t heartbeat = listing("RECEIVE.auv-7", 2);
    heartbeat.age_us = 5'000'000;
    const auto none = [](std::string_view) { return false; };
    const auto all = [](std::string_view) { return true; };
    for (const int ms : {10'000, 10'250}) receiver.on_heartbeat(at_ms(ms), "publisher", heartbeat, none);
    if (is_subscribed_later) receiver.on_subscribed(at_ms(10'300));
    EXPECT_EQ(receiver.on_heartbeat(at_ms(10'500), "publisher", heartbeat, all), is_subscribed_later ? 0 : 3);
  }
}

// A receiver, in its third second, that knows the flows of SENDs of its earlier incarnation.
class ResumedReceiver : public ::testing::Test {
 protected:
  ResumedReceiver() { receiver_.take_heartbeat(SimTime(), at_ms(0)); }
  // After the inputs of the earlier one.
  void go_on() {
    watch_.go_on([](std::string_view channel) { return channel.starts_with("SEND."); });
  }
  // Of two heartbeats, because one makes no flow.
  std::int64_t missing_of(const std::string& channel) {
    const auto all = [](std::string_view) { return true; };
    std::int64_t missing = 0;
    for (const int ms : {2000, 2250})
      missing += receiver_.on_heartbeat(at_ms(ms), "publisher", listing(channel, 2), all);
    return missing;
  }
  FlowWatch watch_;
  FlowRepair receiver_{"receiver", 1, watch_};
};

TEST_F(ResumedReceiver, AFlowThatTheEarlierOneNeverHeardIsMissingFromItsStart) {
  go_on();
  EXPECT_EQ(missing_of("SEND.auv-1"), 3);
}

TEST_F(ResumedReceiver, AFlowOfAChannelThatTheEarlierOneDidNotRememberIsNot) {
  go_on();
  EXPECT_EQ(missing_of("STATE.auv-1"), 0);
}

TEST_F(ResumedReceiver, OfAFlowThatItKnewWhatFollowsIsMissing) {
  watch_.on_message(at_ms(0), "SEND.auv-1", kRestarted, 1);
  go_on();
  EXPECT_EQ(missing_of("SEND.auv-1"), 1);
  const auto requests = receiver_.take_requests(SimTime(), at_ms(2300));
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].missing_sequence, (std::vector<std::int64_t>{2}));
}

}  // namespace
}  // namespace halocline::bus
