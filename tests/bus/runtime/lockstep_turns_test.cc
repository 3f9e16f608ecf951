// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/lockstep_turns.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/lockstep/lockstep_wire.h"
#include "bus/transport/subscription.h"
#include "tests/bus/messages_for_tests.h"
#include "tests/bus/runtime/test_nodes.h"
#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using testing::EchoNode;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::TickingNode;

using halocline::testing::at_ms;

lockstep_turn_t turn_at(SimTime instant, SimTime lookahead = SimTime::at_once()) {
  lockstep_turn_t turn{};
  turn.instant_ns = instant.nanoseconds();
  turn.lookahead_ns = lookahead.nanoseconds();
  turn.max_steps = -1;
  return turn;
}

lockstep_message_t message_on(const std::string& channel) {
  lockstep_message_t message{};
  message.channel_name = channel;
  message.message_bytes = encoded(testing::valid_message<sim_clock_t>(1));
  message.num_message_bytes = static_cast<std::int32_t>(message.message_bytes.size());
  return message;
}

void add_message(lockstep_turn_t& turn, const std::string& channel) {
  turn.inputs.push_back(message_on(channel));
  turn.num_inputs = static_cast<std::int32_t>(turn.inputs.size());
}

std::vector<std::string> channels_published(const lockstep_result_t& result) {
  std::vector<std::string> channels;
  for (const auto& output : result.outputs) channels.push_back(output.channel_name);
  return channels;
}

class LockstepTurnsTest : public ::testing::Test {
 protected:
  lcm::LCM memq_{"memq://"};
  std::vector<std::string> journal_;
  TickingNode ticker_{memq_, "a", SimDuration::from_milliseconds(100), journal_};
  LockstepTurns turns_{ticker_};
};

TEST_F(LockstepTurnsTest, AStepIsTakenAtItsInstantAndItsMessagesAreReturned) {
  const lockstep_result_t result = turns_.take(turn_at(at_ms(0)));
  EXPECT_EQ(result.num_steps, 1);
  EXPECT_THAT(channels_published(result), ElementsAre("TICK.a", "STATUS.a"));
  EXPECT_EQ(result.next_due_ns, at_ms(100).nanoseconds());
}

TEST_F(LockstepTurnsTest, ANodeThatIsNotDueDoesNotStep) {
  turns_.take(turn_at(at_ms(0)));
  const lockstep_result_t result = turns_.take(turn_at(at_ms(50)));
  EXPECT_EQ(result.num_steps, 0);
  EXPECT_THAT(result.outputs, IsEmpty());
}

TEST_F(LockstepTurnsTest, LookaheadCoversAllInstantsBeforeItsEnd) {
  const lockstep_result_t result = turns_.take(turn_at(at_ms(0), at_ms(300)));
  EXPECT_EQ(result.num_steps, 3);
  EXPECT_EQ(result.reached_ns, at_ms(200).nanoseconds());
  EXPECT_EQ(result.outputs.back().instant_ns, at_ms(200).nanoseconds());
}

TEST_F(LockstepTurnsTest, LookaheadEndsWithAStepThatPublishesOnAStoppingChannel) {
  lockstep_turn_t turn = turn_at(at_ms(0), at_ms(300));
  turn.stopping_channels = {"TICK\\..*"};
  turn.only_asks = {0};
  turn.num_stopping = 1;
  EXPECT_EQ(turns_.take(turn).num_steps, 1);
}

TEST_F(LockstepTurnsTest, ANodeThatPromisesNothingHasLookaheadUntilItIsDue) {
  const lockstep_result_t result = turns_.take(turn_at(at_ms(0)));
  EXPECT_EQ(result.lookahead_ns, result.next_due_ns);
}

// But where it publishes STATUS before, once a second, and that matters to others than services.
TEST(LockstepTurnsOfAQuietNode, ItsPromiseCoversTheChannelsThatOthersThanServicesReceive) {
  class Quiet : public TickingNode {
   public:
    using TickingNode::TickingNode;
    SimTime on_lookahead(const ChannelTest& matters) const override {
      return matters("TICK.a") ? SimTime::at_once() : at_ms(5000);
    }
  };
  lcm::LCM memq("memq://");
  std::vector<std::string> journal;
  Quiet quiet(memq, "a", SimDuration::from_milliseconds(100), journal);
  LockstepTurns turns(quiet);
  int instant_ms = 0;
  const auto lookahead = [&](const std::string& channel, bool only_asks) {
    lockstep_turn_t turn = turn_at(at_ms(instant_ms));
    turn.stopping_channels = {channel};
    turn.only_asks = {static_cast<std::int8_t>(only_asks)};
    turn.num_stopping = 1;
    instant_ms += 100;
    return SimTime::from_nanoseconds(turns.take(turn).lookahead_ns);
  };
  EXPECT_EQ(lookahead("OTHER", false), at_ms(5000));
  EXPECT_EQ(lookahead("TICK\\..*", false), at_ms(200));
  EXPECT_EQ(lookahead("TICK\\..*", true), at_ms(5000));
  EXPECT_EQ(lookahead("STATUS\\..*", false), at_ms(1000));
}

TEST_F(LockstepTurnsTest, ReplayedTurnsTakeAsManyStepsAsTheyDid) {
  lockstep_turn_t turn = turn_at(at_ms(0), at_ms(300));
  turn.max_steps = 2;
  EXPECT_EQ(turns_.take(turn).num_steps, 2);
  turn.max_steps = 0;
  EXPECT_EQ(turns_.take(turn).num_steps, 0);
}

TEST_F(LockstepTurnsTest, TheLastTurnStopsTheNode) {
  lockstep_turn_t turn = turn_at(at_ms(0));
  turn.farewell = 1;
  EXPECT_THAT(channels_published(turns_.take(turn)), ElementsAre("STATUS.a"));
  EXPECT_THAT(journal_, ElementsAre("a stopped"));
}

TEST_F(LockstepTurnsTest, TwoIncarnationsWithEqualInputsHaveEqualDigests) {
  lcm::LCM other_memq("memq://");
  std::vector<std::string> other_journal;
  TickingNode other(other_memq, "a", SimDuration::from_milliseconds(100), other_journal);
  LockstepTurns again(other);
  std::int64_t with_lookahead = again.take(turn_at(at_ms(0), at_ms(500))).outputs_digest;
  std::int64_t stepwise = 0;
  for (int ms = 0; ms < 500; ms += 100) stepwise = turns_.take(turn_at(at_ms(ms))).outputs_digest;
  EXPECT_EQ(with_lookahead, stepwise);
}

TEST(LockstepTurnsOfAService, ARequestIsAnsweredInTheSameTurn) {
  lcm::LCM memq("memq://");
  EchoNode echo(memq, "echo", "REQUEST", "ANSWER");
  LockstepTurns turns(echo);
  turns.take(turn_at(at_ms(0)));
  lockstep_turn_t turn = turn_at(at_ms(20));
  add_message(turn, "REQUEST");
  add_message(turn, "NOTHING.to-it");
  EXPECT_THAT(channels_published(turns.take(turn)), ElementsAre("ANSWER"));
}

TEST(LockstepTurnsOfAService, TheIntroductionListsItsSubscriptions) {
  lcm::LCM memq("memq://");
  EchoNode echo(memq, "echo", "ASK.x", "ANSWER");
  const lockstep_join_t join = LockstepTurns(echo).introduction();
  EXPECT_EQ(join.participant_name, "echo");
  EXPECT_THAT(join.subscriptions, ElementsAre("ASK\\.x"));
  EXPECT_THAT(join.only_stores, ElementsAre(0));
}

TEST(LockstepTurnsOfAService, ABrokenPromiseOnlyToStoreIsAnError) {
  class Liar : public EchoNode {
   public:
    explicit Liar(lcm::LCM& lcm) : EchoNode(lcm, "liar", "NONE", "ANSWER") {
      bus().subscribe<sim_clock_t>(
          "REQUEST", [this](const sim_clock_t&) { due_ = SimTime::at_once(); }, Wakeup::kStoreOnly);
    }
    Due on_due() const override { return {.sim = due_}; }

   private:
    SimTime due_ = SimTime::never();
  };
  lcm::LCM memq("memq://");
  Liar liar(memq);
  LockstepTurns turns(liar);
  lockstep_turn_t turn = turn_at(at_ms(0));
  add_message(turn, "REQUEST");
  EXPECT_THROW(turns.take(turn), std::logic_error);
}

}  // namespace
}  // namespace halocline::bus
