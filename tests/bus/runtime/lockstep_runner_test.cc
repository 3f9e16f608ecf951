// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/lockstep_runner.h"

#include <chrono>
#include <cstdint>
#include <semaphore>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/runtime/thread_pool.h"
#include "tests/bus/runtime/test_nodes.h"
#include "tests/support/at_ms.h"
#include "tests/support/process.h"

namespace halocline::bus {
namespace {

using testing::EchoNode;
using ::testing::ElementsAre;
using testing::TickingNode;

SimDuration ms(std::int64_t n) { return SimDuration::from_milliseconds(n); }
using halocline::testing::at_ms;

class LockstepTest : public ::testing::Test {
 protected:
  lcm::LCM lcm_{"memq://"};
  std::vector<std::string> journal_;
};

TEST_F(LockstepTest, StepsEachNodeAtItsInstantsInTheOrderOfTheirNames) {
  TickingNode b(lcm_, "b", ms(200), journal_), a(lcm_, "a", ms(300), journal_);
  LockstepRunner runner({&b, &a});
  runner.run_until(at_ms(600));
  EXPECT_THAT(journal_,
              ElementsAre("a@0", "b@0", "b@200000", "a@300000", "b@400000", "a@600000", "b@600000"));
  EXPECT_EQ(runner.now(), at_ms(600));
}

TEST_F(LockstepTest, ARunInPiecesIsTheRunInOne) {
  std::vector<std::string> whole;
  TickingNode one(lcm_, "a", ms(70), journal_), other(lcm_, "a", ms(70), whole);
  LockstepRunner pieces({&one}), at_once({&other});
  for (const int end : {0, 10, 70, 300, 1000}) pieces.run_until(at_ms(end));
  at_once.run_until(at_ms(1000));
  EXPECT_EQ(journal_, whole);
}

TEST_F(LockstepTest, AnswersToAnswersShareTheInstant) {
  TickingNode ticker(lcm_, "a", ms(100), journal_);
  EchoNode second(lcm_, "second", "FIRST", "SECOND"), first(lcm_, "first", "TICK.a", "FIRST");
  Bus listener(lcm_, {"listener", 1});
  std::vector<std::int64_t> received;
  listener.subscribe<sim_clock_t>("SECOND", [&](const sim_clock_t& m) { received.push_back(m.utime); });
  LockstepRunner runner({&second, &first, &ticker});  // the order that needs most rounds
  runner.set_listener([&](SimTime, std::string_view channel, std::span<const std::uint8_t> message) {
    listener.deliver(channel, message);
  });
  runner.set_before_instant([&](SimTime instant) {
    // Messages published before this instant were received: the bus was empty when time advanced.
    EXPECT_EQ(received.size(), static_cast<std::size_t>(instant.to_utime() / 100'000));
    return true;
  });
  runner.run_until(at_ms(500));
  EXPECT_THAT(received, ElementsAre(0, 100'000, 200'000, 300'000, 400'000, 500'000));
}

TEST_F(LockstepTest, NodesOfOneStageStepOnThreadsAndAreHeardInTheOrderOfTheirNames) {
  std::vector<std::string> of_b, heard;
  TickingNode a(lcm_, "a", ms(100), journal_), b(lcm_, "b", ms(100), of_b);
  std::counting_semaphore begun(0), done(0);
  a.at_step = [&] {  // not without b, which goes first
    begun.release();
    EXPECT_TRUE(done.try_acquire_for(halocline::testing::kHangLimit));
  };
  b.at_step = [&] {
    EXPECT_TRUE(begun.try_acquire_for(halocline::testing::kHangLimit));
    done.release();
  };
  ThreadPool pool(2);
  LockstepRunner runner({&b, &a}, pool.sharing_out());
  runner.set_listener([&](SimTime at, std::string_view channel, std::span<const std::uint8_t>) {
    if (channel.starts_with("TICK"))
      heard.push_back(std::string(channel) + "@" + std::to_string(at.to_utime()));
  });
  runner.run_until(at_ms(100));
  EXPECT_THAT(heard, ElementsAre("TICK.a@0", "TICK.b@0", "TICK.a@100000", "TICK.b@100000"));
}

TEST_F(LockstepTest, WhatAHandlerPublishesIsDeliveredAtTheSameInstant) {
  class Answering : public EchoNode {
   public:
    explicit Answering(lcm::LCM& lcm) : EchoNode(lcm, "answering", "NONE", "NONE") {
      bus().subscribe<sim_clock_t>("TICK.a", [this](const sim_clock_t& m) { bus().publish("ANSWER", m); });
    }
  } answering(lcm_);
  TickingNode ticker(lcm_, "a", ms(100), journal_);
  LockstepRunner runner({&ticker, &answering});
  std::vector<SimTime> heard;
  runner.set_listener([&](SimTime at, std::string_view channel, std::span<const std::uint8_t>) {
    if (channel == "ANSWER") heard.push_back(at);
  });
  runner.run_until(at_ms(200));
  EXPECT_THAT(heard, ElementsAre(at_ms(0), at_ms(100), at_ms(200)));
}

TEST_F(LockstepTest, NodesThatKeepEachOtherBusyAreAnErrorThatNamesTheTime) {
  EchoNode left(lcm_, "left", "A", "B"), right(lcm_, "right", "B", "A");
  TickingNode ticker(lcm_, "t", ms(100), journal_);
  EchoNode starter(lcm_, "starter", "TICK.t", "A");
  LockstepRunner runner({&left, &right, &starter, &ticker});
  EXPECT_THROW(runner.run_until(at_ms(100)), std::runtime_error);
}

TEST_F(LockstepTest, AnExceptionOfAHandlerEndsTheRun) {
  class Faulty : public EchoNode {
   public:
    explicit Faulty(lcm::LCM& lcm) : EchoNode(lcm, "faulty", "TICK.a", "NONE") {
      bus().subscribe<sim_clock_t>("TICK.a", [](const sim_clock_t&) { throw std::runtime_error("boom"); });
    }
  } faulty(lcm_);
  TickingNode ticker(lcm_, "a", ms(100), journal_);
  LockstepRunner runner({&ticker, &faulty});
  EXPECT_THROW(runner.run_until(at_ms(1000)), std::runtime_error);
  EXPECT_EQ(runner.now(), at_ms(0));
}

TEST_F(LockstepTest, MayBeStoppedBeforeAnInstant) {
  TickingNode ticker(lcm_, "a", ms(100), journal_);
  LockstepRunner runner({&ticker});
  runner.set_before_instant([](SimTime instant) { return instant < at_ms(250); });
  runner.run_until(at_ms(1000));
  EXPECT_THAT(journal_, ElementsAre("a@0", "a@100000", "a@200000"));
  runner.stop();
  EXPECT_EQ(journal_.back(), "a stopped");
}

}  // namespace
}  // namespace halocline::bus
