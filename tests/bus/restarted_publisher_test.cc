// SPDX-License-Identifier: BSD-3-Clause
// A process that was killed and started again is a rival of the one before for a second, and its messages are refused (session_watch.h):
// what it published meanwhile is repaired.
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

}  // namespace
}  // namespace halocline::bus
