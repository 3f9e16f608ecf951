// SPDX-License-Identifier: BSD-3-Clause
// Requests and heartbeats that somebody makes up.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "bus/messages/messages.h"
#include "bus/repair/flow_repair.h"
#include "bus/repair/flow_watch.h"
#include "core/sim_time.h"

namespace halocline::bus {
namespace {

flow_heartbeat_t heartbeat_of_flows(int flows, std::int64_t session) {
  flow_heartbeat_t heartbeat{};
  heartbeat.session = session;
  for (int i = 0; i < flows; ++i) {
    heartbeat.flow_channel.push_back("STATE.v" + std::to_string(i));
    heartbeat.flow_session.push_back(session);
    heartbeat.flow_last_sequence.push_back(1'000'000);
  }
  heartbeat.num_flows = heartbeat.num_flows_kept = flows;
  return heartbeat;
}

TEST(FlowRepair, AHeartbeatByItselfMakesNoFlow) {
  const auto any = [](std::string_view) { return true; };
  FlowWatch watch;
  FlowRepair repair("receiver", 1, watch);
  for (std::int64_t session = 1; session <= 11; ++session)
    EXPECT_EQ(repair.on_heartbeat(SimTime(), "publisher", heartbeat_of_flows(500, session), any), 0);
  EXPECT_EQ(watch.num_missing(), 0u);
  EXPECT_EQ(watch.next_due(), SimTime::never());
}

// What a publisher of `published` messages sends in `seconds` when these are requested `per_s` times a
// second, `numbers` at a time: each time the same, or all in turn.
int answers_to(int published, int seconds, int per_s, int numbers, bool in_turn) {
  FlowWatch watch;
  FlowRepair repair("publisher", 1, watch);
  for (int i = 0; i < published; ++i) repair.on_published("STATE.a", 1, i, Bytes(100));
  repair_request_t request{};
  request.missing_channel = "STATE.a";
  request.publisher_session = 1;
  std::size_t answers = 0;
  int next = 0;
  for (int ms = 0; ms < 1000 * seconds; ++ms) {
    const SimTime steady = SimTime() + SimDuration::from_milliseconds(ms);
    if (ms % (1000 / per_s) == 0) {
      request.missing_sequence.clear();
      for (int i = 0; i < numbers; ++i) request.missing_sequence.push_back(in_turn ? next++ % published : i);
      repair.on_request(steady, request);
    }
    if (repair.next_due() <= steady) answers += repair.take_answers(steady).size();
  }
  return static_cast<int>(answers);
}

TEST(FlowRepair, AMessageIsAnsweredOnceInFortyMilliseconds) {
  EXPECT_EQ(answers_to(1000, 1, 1000, 1, false), 25);
}

// 50 requests a second for 200 messages each would be 100 000 datagrams in 10 s.
TEST(FlowRepair, AFloodOfRequestsGetsNoMoreThanTheBucketHolds) {
  for (const bool in_turn : {false, true}) {
    const int answers = answers_to(1000, 10, 50, 200, in_turn);
    EXPECT_LE(answers, FlowRepair::kMinAnswers + 1000 * FlowRepair::kAnswersPerMessage +
                           10 * FlowRepair::kAnswersPerS);
    EXPECT_GE(answers, 1000);  // those in need get theirs
  }
}

}  // namespace
}  // namespace halocline::bus
