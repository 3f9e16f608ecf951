// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/node.h"

#include <memory>
#include <stdexcept>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/transport/event_log.h"
#include "bus/version.h"
#include "core/check.h"
#include "tests/bus/messages_for_tests.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/bus/runtime/test_nodes.h"

namespace halocline::bus {
namespace {

using testing::EchoNode;
using testing::TickingNode;

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

class NodeTest : public ::testing::Test {
 protected:
  NodeTest() {
    set_log_level(LogLevel::kSilent);
    listener_.subscribe<node_status_t>(
        channels::kStatus, [this](std::string_view, const node_status_t& m) { statuses_.push_back(m); });
  }
  ~NodeTest() override { set_log_level(LogLevel::kInfo); }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }

  lcm::LCM lcm_{"memq://"};
  Bus listener_{lcm_, {"listener", 9}};
  std::vector<node_status_t> statuses_;
  std::vector<std::string> journal_;
};

TEST_F(NodeTest, PublishesItsStatusOnceASecondOfSteadyTime) {
  TickingNode node(lcm_, "a", SimDuration::from_milliseconds(100), journal_);
  for (int step = 0; step <= 30; ++step) node.step({at(100 + 0.1 * step), at(0.1 * step)});
  drain();
  ASSERT_EQ(statuses_.size(), 4u);  // at 0, 1, 2 and 3 s
  EXPECT_EQ(statuses_[3].utime, 103'000'000);
  EXPECT_EQ(statuses_[3].sequence, 3);
  EXPECT_EQ(statuses_[3].node_name, "a");
  EXPECT_EQ(statuses_[3].node_version, kVersion);
  EXPECT_EQ(statuses_[3].status_text, "ticking");
}

TEST_F(NodeTest, ItsStatusCarriesItsCounters) {
  EchoNode node(lcm_, "echo", "REQUEST", "ANSWER");
  listener_.publish("REQUEST", testing::valid_message<sim_clock_t>(1));
  sim_clock_t impossible = testing::valid_message<sim_clock_t>(1);
  impossible.clock_rate = -1;
  listener_.publish("REQUEST", impossible);
  drain();
  node.step({at(1), at(1)});
  drain();
  ASSERT_EQ(statuses_.size(), 1u);
  EXPECT_EQ(statuses_[0].messages_received, 1);
  EXPECT_EQ(statuses_[0].messages_refused, 1);
  EXPECT_EQ(statuses_[0].messages_sent, 1);
}

TEST_F(NodeTest, PublishesAFinalStatus) {
  TickingNode node(lcm_, "a", SimDuration::from_milliseconds(100), journal_);
  node.stop({at(5), at(5)});
  drain();
  ASSERT_EQ(statuses_.size(), 1u);
  EXPECT_EQ(statuses_[0].status_text, "stopped; ticking");
  EXPECT_THAT(journal_, ::testing::ElementsAre("a stopped"));
}

TEST_F(NodeTest, WithoutSimulationTimeItPublishesItsStatusAlone) {
  TickingNode node(lcm_, "a", SimDuration::from_milliseconds(100), journal_);
  node.step({SimTime(), at(1), false});
  drain();
  EXPECT_TRUE(journal_.empty());
  EXPECT_EQ(statuses_.size(), 1u);
}

TEST_F(NodeTest, AnswersRequestsEvenWithoutSimulationTime) {
  EchoNode node(lcm_, "echo", "REQUEST", "ANSWER");
  listener_.publish("REQUEST", testing::valid_message<sim_clock_t>(1));
  drain();
  EXPECT_EQ(node.due().sim, SimTime::at_once());
  node.step({SimTime(), at(1), false});
  EXPECT_EQ(node.answers, 1);
}

TEST_F(NodeTest, IsNotifiedOfANewRun) {
  TickingNode node(lcm_, "a", SimDuration::from_milliseconds(100), journal_);
  node.step({at(500), at(1)});
  node.restart({at(0), at(2)});
  EXPECT_EQ(node.restarts, 1);
  node.step({at(0), at(2)});
  EXPECT_EQ(journal_.back(), "a@0");
}

TEST_F(NodeTest, IsDueAtItsNextStatusAtTheLatest) {
  TickingNode node(lcm_, "a", SimDuration::from_seconds(1000), journal_);
  node.step({at(0), at(0.25)});
  EXPECT_EQ(node.due().steady, at(1));
  EXPECT_EQ(node.due().sim, at(1000));
}

// A node that ticks ten times a second, killed after its tick at 2 s.
class KilledNode : public NodeTest {
 protected:
  KilledNode() {
    listener_.subscribe<sim_clock_t>("TICK.a", [this](const sim_clock_t& m) { ticks_.push_back(m); });
    const auto node = start();
    for (int step = 0; step <= 20; ++step) node->step({at(0.1 * step), at(0.1 * step)});
    drain();
    EXPECT_EQ(node->counters().sent, 21 + 3 + 7);  // ticks, STATUS, heartbeats
  }
  std::unique_ptr<TickingNode> start() {
    auto node = std::make_unique<TickingNode>(lcm_, "a", SimDuration::from_milliseconds(100), journal_);
    node->enable_repair();
    node->keep_state_in(files_.open());
    return node;
  }

  testing::JournalFiles files_;
  std::vector<sim_clock_t> ticks_;
};

TEST_F(KilledNode, GoesOnWithItsStateAndItsNumbers) {
  start()->step({at(2.25), at(0)});
  drain();
  ASSERT_EQ(ticks_.size(), 22u);
  EXPECT_EQ(ticks_.back().utime, 2'250'000);
  EXPECT_EQ(ticks_.back().sequence, 21);
  EXPECT_EQ(statuses_.back().sequence, 3);
}

TEST_F(KilledNode, ItsLastMessagesAreStillRepaired) {
  const auto node = start();
  std::vector<std::int64_t> repaired;
  listener_.subscribe<sim_clock_t>(channels::kRepair.of("TICK.a"),
                                   [&](const sim_clock_t& m) { repaired.push_back(m.sequence); });
  repair_request_t request{};
  request.client_name = "ear";
  request.missing_channel = "TICK.a";
  request.publisher_session = 1;
  request.num_missing = 2;
  request.missing_sequence = {20, 21};
  listener_.publish(channels::kRepairRequest, request);
  drain();
  EXPECT_EQ(node->due().steady, SimTime::at_once());
  node->step({at(2.0), at(0)});
  drain();
  EXPECT_THAT(repaired, ::testing::ElementsAre(20));
}

TEST_F(KilledNode, InAnotherRunItBeginsAnew) {
  const auto node = start();
  node->step({at(-10), at(0)});
  EXPECT_EQ(node->restarts, 1);
}

TEST_F(KilledNode, WhatItWasToPublishIsKnownToTheJournalFirst) {
  auto node = start();
  node->at_step = [] { throw std::runtime_error("killed"); };  // before its tick went out
  EXPECT_THROW(node->step({at(2.1), at(0)}), std::runtime_error);
  node.reset();
  drain();
  EXPECT_EQ(ticks_.size(), 21u);
  start()->step({at(2.2), at(0)});
  drain();
  ASSERT_EQ(ticks_.size(), 22u);
  EXPECT_EQ(ticks_.back().sequence, 21);
}

TEST_F(KilledNode, AJournalOfAnotherSessionIsRefused) {
  EchoNode node(lcm_, "echo", "ASK", "ANSWER", 2);
  EXPECT_THROW(node.keep_state_in(files_.open()), InvalidArgument);
}

// Else a last message that the network loses would be lost with its publisher.
TEST_F(NodeTest, AfterItsLastStepItAnnouncesItsFlowsAndAnswersWhoMissesTheirEnd) {
  TickingNode node(lcm_, "a", SimDuration::from_milliseconds(100), journal_);
  node.enable_repair();
  std::vector<flow_heartbeat_t> heartbeats;
  int repairs = 0;
  listener_.subscribe<flow_heartbeat_t>(
      channels::kHeartbeat,
      [&](std::string_view, const flow_heartbeat_t& heartbeat) { heartbeats.push_back(heartbeat); });
  listener_.subscribe_to_all([&](std::string_view channel, const void*, std::size_t) {
    repairs += channel == "STATUS.a" ? 1 : 0;  // under its own channel, like the first
  });
  node.stop({at(5), at(5)});
  EXPECT_FALSE(node.repair_after_stop({at(5), at(5)}, true));
  drain();
  ASSERT_EQ(heartbeats.size(), 1u);
  EXPECT_THAT(heartbeats[0].flow_channel, ::testing::ElementsAre("STATUS.a"));
  EXPECT_FALSE(node.repair_after_stop({at(5.01), at(5.01)}, false));
  repair_request_t request;
  request.utime = 0;
  request.client_name = "listener";
  request.missing_channel = "STATUS.a";
  request.publisher_session = heartbeats[0].flow_session[0];
  request.num_missing = 1;
  request.missing_sequence = {heartbeats[0].flow_last_sequence[0]};
  listener_.publish(channels::kRepairRequest, request);
  drain();
  EXPECT_TRUE(node.repair_after_stop({at(5.02), at(5.02)}, false));
  drain();
  EXPECT_EQ(repairs, 2);
}

}  // namespace
}  // namespace halocline::bus
