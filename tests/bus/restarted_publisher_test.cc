// SPDX-License-Identifier: BSD-3-Clause
// A process that was killed and started again. As a publisher it is a rival of the one before for a second, and its messages are refused
// (session_watch.h): what it published meanwhile is repaired. As a receiver it goes on with the flows that the one before knew.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "bus/flow_repair.h"
#include "bus/flow_watch.h"
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

TEST(RestartedPublisher, AFlowThatBeganWhileItWasARivalIsRequestedWhole) {
  for (const int rival_heartbeats : {1, 2, 3}) {
    FlowWatch watch;
    FlowRepair receiver("receiver", 1, watch);
    receiver.take_heartbeat(SimTime(), at_ms(0));
    const auto none = [](std::string_view) { return false; };
    const auto all = [](std::string_view) { return true; };
    for (int i = 0; i < rival_heartbeats; ++i)
      EXPECT_EQ(receiver.on_heartbeat(at_ms(10'000 + 250 * i), heartbeat_of(i), none), 0);
    flow_heartbeat_t believed = heartbeat_of(4);
    believed.num_flows = believed.num_flows_kept = 1;
    believed.flow_channel = {"RECEIVE.auv-7"};
    believed.flow_session = {kRestarted};
    believed.flow_last_sequence = {2};
    EXPECT_EQ(receiver.on_heartbeat(at_ms(11'000), believed, all), 3) << rival_heartbeats;
    const auto requests = receiver.take_requests(SimTime(), at_ms(11'010));
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].missing_sequence, (std::vector<std::int64_t>{0, 1, 2}));
  }
}

// A heartbeat of a publisher older than all receivers, whose flow has published 0, 1, 2.
flow_heartbeat_t listing(const std::string& channel) {
  flow_heartbeat_t heartbeat = heartbeat_of(40);
  heartbeat.num_flows = heartbeat.num_flows_kept = 1;
  heartbeat.flow_channel = {channel};
  heartbeat.flow_session = {kRestarted};
  heartbeat.flow_last_sequence = {2};
  return heartbeat;
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
    for (const int ms : {2000, 2250}) missing += receiver_.on_heartbeat(at_ms(ms), listing(channel), all);
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
