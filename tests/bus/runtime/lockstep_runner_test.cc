#include "bus/runtime/lockstep_runner.h"

#include <cstdint>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bus/runtime/test_nodes.h"

namespace halocline::bus {
namespace {

using testing::EchoNode;
using ::testing::ElementsAre;
using testing::TickingNode;

SimDuration ms(std::int64_t n) { return SimDuration::from_milliseconds(n); }
SimTime at_ms(std::int64_t n) { return SimTime() + ms(n); }

class LockstepTest : public ::testing::Test {
 protected:
  lcm::LCM lcm_{"memq://"};
  std::vector<std::string> journal_;
};

TEST_F(LockstepTest, StepsEachNodeAtItsInstantsInTheOrderOfTheirNames) {
  TickingNode b(lcm_, "b", ms(200), journal_), a(lcm_, "a", ms(300), journal_);
  LockstepRunner runner(lcm_, {&b, &a});
  runner.run_until(at_ms(600));
  EXPECT_THAT(journal_,
              ElementsAre("a@0", "b@0", "b@200000", "a@300000", "b@400000", "a@600000", "b@600000"));
  EXPECT_EQ(runner.now(), at_ms(600));
}

TEST_F(LockstepTest, ARunInPiecesIsTheRunInOne) {
  std::vector<std::string> whole;
  TickingNode one(lcm_, "a", ms(70), journal_), other(lcm_, "a", ms(70), whole);
  LockstepRunner pieces(lcm_, {&one}), at_once(lcm_, {&other});
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
  LockstepRunner runner(lcm_, {&second, &first, &ticker});  // the order that needs most rounds
  runner.set_before_instant([&](SimTime instant) {
    // Messages published before this instant were received: the bus was empty when time advanced.
    EXPECT_EQ(received.size(), static_cast<std::size_t>(instant.to_utime() / 100'000));
    return true;
  });
  runner.run_until(at_ms(500));
  EXPECT_THAT(received, ElementsAre(0, 100'000, 200'000, 300'000, 400'000, 500'000));
}

TEST_F(LockstepTest, NodesThatKeepEachOtherBusyAreAnErrorThatNamesTheTime) {
  EchoNode left(lcm_, "left", "A", "B"), right(lcm_, "right", "B", "A");
  TickingNode ticker(lcm_, "t", ms(100), journal_);
  Bus publisher(lcm_, {"publisher", 1});
  sim_clock_t message;
  message.utime = message.session = message.sequence = 0;
  message.clock_rate = 1;
  message.clock_step_us = 1;
  message.lockstep = 0;
  ticker.at_step = [&] { publisher.publish("A", message); };
  LockstepRunner runner(lcm_, {&left, &right, &ticker});
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
  LockstepRunner runner(lcm_, {&ticker, &faulty});
  EXPECT_THROW(runner.run_until(at_ms(1000)), std::runtime_error);
  EXPECT_EQ(runner.now(), at_ms(0));
}

TEST_F(LockstepTest, MayBeStoppedBeforeAnInstant) {
  TickingNode ticker(lcm_, "a", ms(100), journal_);
  LockstepRunner runner(lcm_, {&ticker});
  runner.set_before_instant([](SimTime instant) { return instant < at_ms(250); });
  runner.run_until(at_ms(1000));
  EXPECT_THAT(journal_, ElementsAre("a@0", "a@100000", "a@200000"));
  runner.stop();
  EXPECT_EQ(journal_.back(), "a stopped");
}

}  // namespace
}  // namespace halocline::bus
