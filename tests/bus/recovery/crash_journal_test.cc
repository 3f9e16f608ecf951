// SPDX-License-Identifier: BSD-3-Clause
// A node that adds numbers and publishes each sum: killed and restored from its journal it
// publishes what it would have published without the kill.
#include "bus/recovery/crash_journal.h"

#include <filesystem>
#include <memory>

#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/transport/event_log.h"

namespace halocline::bus {
namespace {

constexpr std::string_view kInputs = "RAY_QUERY";
using Numbers = std::vector<std::int64_t>;

ray_query_t input(std::int64_t number) {
  ray_query_t message{};
  message.utime = number;
  message.client_name = "client";
  message.request_id = number;
  return message;
}

// An incarnation of the node: sums request ids, publishes the sum after each step.
struct Incarnation {
  Incarnation(lcm::LCM& bus_lcm, const std::string& path, std::int64_t session)
      : lcm(bus_lcm), bus(lcm, {"adder", session}), publisher(bus), journal(bus, publisher) {
    bus.subscribe<ray_query_t>(kInputs, [this](const ray_query_t& m) { inbox.push_back(m.request_id); });
    journal.open({path,
                  SimDuration::from_seconds(60.0),
                  [](std::string_view channel) { return channel == kInputs; },
                  {},
                  {}});
    journal.replay_inputs([this](SimTime at) { replayed.emplace_back(at, std::exchange(inbox, {})); });
    bus.enable_repair();
  }
  void add(double t, const Numbers& numbers) {
    for (const std::int64_t number : numbers) sum += number;
    packet_outcome_t outcome{};
    outcome.num_receivers = 1;
    outcome.utime = SimTime::from_seconds(t).to_utime();
    outcome.source_id = static_cast<std::int32_t>(sum);
    outcome.receiver_id = 1;
    if (journal.publish_once(std::string(channels::kOutcome), outcome, std::to_string(outcome.utime)))
      published.push_back(outcome.source_id);
  }
  [[nodiscard]] bool resume(double t) {
    if (!journal.resume(SimTime::from_seconds(t))) return false;
    for (const auto& [at, numbers] : replayed) {
      journal.redo_step(at);
      add(at.seconds(), numbers);
    }
    return true;
  }
  void step(double t) {
    while (lcm.handleTimeout(0) > 0) {
    }
    journal.write_inputs(SimTime::from_seconds(t));
    add(t, std::exchange(inbox, {}));
    journal.end_recovery();
  }

  lcm::LCM& lcm;
  Bus bus;
  NumberedPublisher publisher;
  CrashJournal journal;
  Numbers inbox, published;
  std::vector<std::pair<SimTime, Numbers>> replayed;
  std::int64_t sum = 0;
};

class CrashJournalTest : public ::testing::Test {
 protected:
  CrashJournalTest() { set_log_level(LogLevel::kSilent); }
  ~CrashJournalTest() override {
    for (const char* part : {"", ".1", ".new"}) std::filesystem::remove(path_ + part);
  }
  std::unique_ptr<Incarnation> start() { return std::make_unique<Incarnation>(lcm_, path_, ++session_); }
  void publish(std::int64_t number) { source_.publish(kInputs, input(number)); }

  lcm::LCM lcm_{"memq://"};
  Bus source_{lcm_, {"source", 1}};
  const std::string path_ = ::testing::TempDir() + "halocline-crash-journal-" + std::to_string(getpid());
  std::int64_t session_ = 100;
};

TEST_F(CrashJournalTest, ReplaysTheInputsOfEachStep) {
  auto node = start();
  for (int second = 1; second <= 3; ++second) {
    publish(second);
    publish(10 * second);
    node->step(second);
  }
  node = start();
  ASSERT_EQ(node->replayed.size(), 3u);
  EXPECT_EQ(node->replayed[1].first, SimTime::from_seconds(2.0));
  EXPECT_EQ(node->replayed[1].second, (Numbers{2, 20}));
  EXPECT_EQ(node->journal.last_step(), SimTime::from_seconds(3.0));
}

TEST_F(CrashJournalTest, WhatAnEarlierIncarnationPublishedIsNotPublishedAgain) {
  auto node = start();
  for (int second = 1; second <= 3; ++second) {
    publish(second);
    node->step(second);
  }
  EXPECT_EQ(node->published, (Numbers{1, 3, 6}));
  node = start();
  EXPECT_TRUE(node->resume(3.5));
  publish(4);
  node->step(4);
  EXPECT_EQ(node->published, (Numbers{10}));
}

TEST_F(CrashJournalTest, AnOutputThatWasNotPublishedIsPublishedOnReplay) {
  auto node = start();
  publish(1);
  node->step(1);
  publish(2);
  while (lcm_.handleTimeout(0) > 0) {
  }
  node->journal.write_inputs(SimTime::from_seconds(2.0));  // killed before it publishes
  node = start();
  EXPECT_TRUE(node->resume(2.5));
  EXPECT_EQ(node->published, (Numbers{3}));
}

TEST_F(CrashJournalTest, NumbersAndSessionOfTheChannelsGoOn) {
  std::vector<std::pair<std::int64_t, std::int64_t>> received;
  Bus receiver(lcm_, {"receiver", 2});
  receiver.subscribe<packet_outcome_t>(channels::kOutcome, [&](const packet_outcome_t& message) {
    received.emplace_back(message.session, message.sequence);
  });
  auto node = start();
  publish(1);
  node->step(1);
  node = start();
  EXPECT_TRUE(node->resume(1.5));
  publish(2);
  node->step(2);
  while (lcm_.handleTimeout(0) > 0) {
  }
  EXPECT_EQ(received, (std::vector<std::pair<std::int64_t, std::int64_t>>{{101, 0}, {101, 1}}));
}

TEST_F(CrashJournalTest, AJournalOfAnotherRunOrOfLongAgoIsForgotten) {
  for (const double t : {10.0, 200.0}) {
    auto node = start();
    publish(1);
    node->step(100);
    node = start();
    EXPECT_FALSE(node->resume(t));
    EXPECT_FALSE(start()->journal.last_step().has_value());
  }
}

TEST_F(CrashJournalTest, UnlessOpenedItPublishesAndKeepsNothing) {
  Bus bus(lcm_, {"adder", 3});
  NumberedPublisher publisher(bus);
  CrashJournal journal(bus, publisher);
  journal.write_inputs(SimTime::from_seconds(1.0));
  EXPECT_TRUE(journal.publish_once(std::string(channels::kOutcome), packet_outcome_t{}, "1"));
  EXPECT_TRUE(journal.publish_once(std::string(channels::kOutcome), packet_outcome_t{}, "1"));
  EXPECT_EQ(bus.counters().sent, 2);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace halocline::bus
