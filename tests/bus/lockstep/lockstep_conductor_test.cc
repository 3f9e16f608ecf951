// SPDX-License-Identifier: BSD-3-Clause
// The lockstep protocol on a simulated network: whatever is lost and whoever crashes, the messages of the run
// and their order are those of one process.
#include "bus/lockstep/lockstep_conductor.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/runtime/lockstep_turns.h"
#include "tests/bus/lockstep/chatty_node.h"
#include "tests/bus/lockstep/simulated_lockstep.h"

namespace halocline::conductor {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Messages;
using testing::NetworkRules;
using ::testing::Not;
using testing::SimulatedLockstep;
using ::testing::StartsWith;

const SimTime kEnd = SimTime::from_seconds(2);

// HALOCLINE_LOCKSTEP_SEEDS: how many random networks each test tries.
unsigned seeds(unsigned usually) {
  const char* requested = std::getenv("HALOCLINE_LOCKSTEP_SEEDS");
  return requested == nullptr ? usually : static_cast<unsigned>(std::atoi(requested));
}

const Messages& reference() {
  static const Messages messages = testing::messages_of_one_process(testing::five_nodes(), kEnd);
  return messages;
}

std::string last_reports(SimulatedLockstep& run) {
  std::string text = "waiting for";
  for (const std::string& name : run.conductor().waiting_for()) text += " " + name;
  text += "\n";
  const std::size_t count = run.reports().size();
  for (std::size_t i = count - std::min<std::size_t>(count, 12); i < count; ++i)
    text += run.reports()[i] + "\n";
  return text;
}

void expect_the_same_messages(const NetworkRules& rules, unsigned count,
                              const std::vector<testing::NodeRule>& nodes = testing::five_nodes()) {
  int crashes = 0;
  const Messages expected = testing::messages_of_one_process(nodes, kEnd);
  for (unsigned seed = 0; seed < seeds(count); ++seed) {
    SimulatedLockstep run(nodes, kEnd, rules, seed);
    ASSERT_NO_THROW(run.run()) << "seed " << seed << ", " << last_reports(run);
    const Messages& messages = run.messages();
    const auto differs = std::mismatch(messages.begin(), messages.end(), expected.begin(), expected.end());
    ASSERT_TRUE(messages == expected)
        << "seed " << seed << ": differs from message " << differs.first - messages.begin() << " on, of "
        << messages.size() << " and " << expected.size();
    crashes += run.crashes();
  }
  if (rules.participant_crashes_per_s + rules.conductor_crashes_per_s > 0) {
    EXPECT_GT(crashes, static_cast<int>(seeds(count))) << "a test of crashes needs crashes";
  }
}

TEST(LockstepConductor, PublishesTheMessagesOfOneProcess) {
  EXPECT_GT(reference().size(), 150u);
  expect_the_same_messages({}, 20);
}

TEST(LockstepConductor, PublishesTheSameWithoutLookahead) {
  expect_the_same_messages({.lookahead = false}, 20);
}

TEST(LockstepConductor, PublishesTheSameWithParticipantsInItsOwnProcess) {
  expect_the_same_messages({.loss = 0.1, .conductor_crashes_per_s = 5, .local = 2}, 30);
}

TEST(LockstepConductor, PublishesTheSameWhenDatagramsAreLostDuplicatedAndReordered) {
  for (const double loss : {0.01, 0.05, 0.2, 0.5}) {
    expect_the_same_messages(
        {.loss = loss, .duplication = 0.2, .longest_delay = SimDuration::from_milliseconds(20)}, 20);
  }
}

TEST(LockstepConductor, PublishesTheSameWhenParticipantsCrashAndReturn) {
  expect_the_same_messages({.loss = 0.05, .duplication = 0.05, .participant_crashes_per_s = 30}, 60);
}

TEST(LockstepConductor, PublishesTheSameWhenTheConductorCrashesAndReturns) {
  expect_the_same_messages({.loss = 0.05, .duplication = 0.05, .conductor_crashes_per_s = 20}, 60);
}

TEST(LockstepConductor, PublishesTheSameWhenAllCrashAndReturn) {
  expect_the_same_messages({.loss = 0.1,
                            .duplication = 0.1,
                            .longest_delay = SimDuration::from_milliseconds(5),
                            .participant_crashes_per_s = 20,
                            .conductor_crashes_per_s = 20},
                           150);
}

TEST(LockstepConductor, PublishesTheSameWhereAStageSharesLookahead) {
  expect_the_same_messages({}, 20, testing::sharing_nodes());
  expect_the_same_messages({.lookahead = false}, 3, testing::sharing_nodes());
  expect_the_same_messages(
      {.loss = 0.1, .duplication = 0.1, .longest_delay = SimDuration::from_milliseconds(5)}, 10,
      testing::sharing_nodes());
}

TEST(LockstepConductor, PublishesTheSameWhereAStageSharesLookaheadAndAllCrashAndReturn) {
  expect_the_same_messages({.loss = 0.05, .participant_crashes_per_s = 20, .conductor_crashes_per_s = 10}, 40,
                           testing::sharing_nodes());
}

TEST(LockstepConductor, SharedLookaheadSavesExchanges) {
  SimulatedLockstep with(testing::sharing_nodes(), kEnd, {}, 1);
  SimulatedLockstep without(testing::sharing_nodes(), kEnd, {.lookahead = false}, 1);
  with.run();
  without.run();
  EXPECT_LT(with.conductor().sequencer().rounds(), without.conductor().sequencer().rounds() / 2);
}

TEST(LockstepConductor, WhoPublishesBeforeTheInstantThatItPromisedEndsTheRun) {
  auto nodes = testing::sharing_nodes();
  nodes[5].kind = testing::NodeRule::Kind::kLiar;
  SimulatedLockstep run(nodes, kEnd, {}, 1);
  EXPECT_THROW(run.run(), std::runtime_error);
}

// Wherever it crashes, its last output included: the run ends, and its log is whole.
TEST(LockstepConductor, PublishesTheSameWhereverItCrashes) {
  const SimTime end = SimTime::from_seconds(0.3);
  const Messages expected = testing::messages_of_one_process(testing::five_nodes(), end);
  int output = 0;
  for (bool crashed = true; crashed; ++output) {
    SimulatedLockstep run(testing::five_nodes(), end, {.conductor_crashes_at = output}, 1);
    ASSERT_NO_THROW(run.run(SimDuration::from_seconds(30)))
        << "output " << output << ", " << last_reports(run);
    ASSERT_TRUE(run.messages() == expected) << "output " << output;
    crashed = run.crashes() > 0;
  }
  EXPECT_GT(output, 100);  // the sweep covers a run, which has 125 outputs
}

TEST(LockstepConductor, AJournalOfAnotherScenarioIsRefused) {
  lockstep_join_t join{};
  join.incarnation = 9;
  join.participant_name = "a";
  join.scenario_digest = "scenario=that";
  LockstepConductor::Outputs outputs;
  outputs.report = [](const std::string&, const std::string&) {};
  LockstepConductor same({.expected = {"a"}, .end = kEnd, .agreement = "scenario=that"}, 5, outputs);
  LockstepConductor other({.expected = {"a"}, .end = kEnd, .agreement = "scenario=this"}, 5, outputs);
  const std::vector<JournalEntry> journal{{EntryKind::kRun, {'5'}}, {EntryKind::kJoin, bus::encoded(join)}};
  EXPECT_NO_THROW(same.resume(journal));
  EXPECT_THROW(other.resume(journal), std::runtime_error);
}

TEST(LockstepConductor, LookaheadSavesExchanges) {
  SimulatedLockstep with(testing::five_nodes(), kEnd, {}, 1);
  SimulatedLockstep without(testing::five_nodes(), kEnd, {.lookahead = false}, 1);
  with.run();
  without.run();
  EXPECT_LT(with.conductor().sequencer().rounds(), without.conductor().sequencer().rounds());
}

TEST(LockstepConductor, WaitsForACrashedParticipantWithoutATimeout) {
  SimulatedLockstep run(testing::five_nodes(), kEnd, {.crashes_for_good_after = 10}, 1);
  EXPECT_THROW(run.run(SimDuration::from_seconds(30)), std::runtime_error);
  EXPECT_THAT(run.conductor().waiting_for(), Contains("server"));
}

TEST(LockstepConductor, DropsACrashedParticipantAfterTheTimeoutAndReportsIt) {
  const NetworkRules rules{.drop_after = SimDuration::from_seconds(2), .crashes_for_good_after = 10};
  SimulatedLockstep run(testing::five_nodes(), kEnd, rules, 1);
  run.run();
  EXPECT_THAT(run.reports(), Contains(StartsWith("dropped participant=server")));
  EXPECT_GT(run.messages().size(), reference().size() / 2);
}

TEST(LockstepConductor, ADroppedParticipantMayReturn) {
  const NetworkRules rules{.drop_after = SimDuration::from_seconds(1), .crashes_for_good_after = -1};
  SimulatedLockstep run(testing::five_nodes(), SimTime::from_seconds(40), rules, 1);
  int phase = 0;
  run.between_events = [&](SimulatedLockstep& now) {
    const bool dropped = !now.conductor().sequencer().takes_part("server");
    const auto turns = now.conductor().sequencer().turns_taken("server");
    if (phase == 0 && turns >= 10) {
      now.crash_participant(4);
      ++phase;
    } else if (phase == 1 && dropped) {
      now.start_participant(4);
      ++phase;
    } else if (phase == 2 && !dropped && turns > 20) {
      ++phase;
    }
  };
  run.run();
  EXPECT_EQ(phase, 3);
  EXPECT_THAT(run.reports(), Contains(StartsWith("returned participant=server")));
}

// A fixed bug: the new incarnation lacks the turn for which the round already has an answer.
TEST(LockstepConductor, AParticipantThatCrashesBetweenItsAnswerAndTheOthersMissesNoTurn) {
  SimulatedLockstep run(testing::five_nodes(), kEnd, {}, 1);
  bool crashed = false;
  run.between_events = [&](SimulatedLockstep& now) {
    const auto& round = now.conductor().sequencer().round();
    const auto missing = now.conductor().waiting_for();
    if (crashed || round.size() < 2 || missing.size() != 1 || missing[0] != "mover-b") return;
    now.crash_participant(1);
    now.crash_participant(2);
    now.start_participant(1);
    now.start_participant(2);
    crashed = true;
  };
  run.run(SimDuration::from_seconds(30));
  EXPECT_TRUE(crashed);
  EXPECT_TRUE(run.messages() == reference());
}

TEST(LockstepConductor, AParticipantThatRequestsToLeaveTakesItsLastTurnAndTheOthersContinue) {
  SimulatedLockstep run(testing::five_nodes(), SimTime::from_seconds(20), {.loss = 0.1}, 1);
  bool requested = false;
  run.between_events = [&](SimulatedLockstep& now) {
    if (requested || now.conductor().sequencer().turns_taken("pilot") < 10) return;
    now.participant(3)->request_leave();
    requested = true;
  };
  run.run();
  EXPECT_EQ(run.participant(3)->state(), bus::LockstepParticipant::State::kOver);
  EXPECT_THAT(run.reports(), Contains(StartsWith("leaves participant=pilot")));
  EXPECT_THAT(run.messages().back(), HasSubstr("STATUS.server"));
}

TEST(LockstepConductor, ALateParticipantJoinsAtTheInstantReported) {
  auto nodes = testing::five_nodes();
  SimulatedLockstep run(nodes, SimTime::from_seconds(20), {.loss = 0.05}, 1);
  lcm::LCM memq("memq://");
  testing::ChattyNode late(memq, "late", bus::Stage::kClients, SimDuration::from_milliseconds(40), {"pilot"},
                           "pilot");
  bus::LockstepTurns turns(late);
  bool joined = false;
  run.between_events = [&](SimulatedLockstep& now) {
    if (joined || now.conductor().sequencer().turns_taken("pilot") < 10) return;
    now.conductor().add_local(turns.introduction(), [&](const lockstep_turn_t& t) { return turns.take(t); });
    joined = true;
  };
  run.run();
  EXPECT_THAT(run.reports(), Contains(StartsWith("joined participant=late t=")));
  EXPECT_THAT(run.messages(), Contains(HasSubstr("NEWS.late")));
}

TEST(LockstepConductor, TheCostOfARoundIsAGrantAndAnAnswerEach) {
  SimulatedLockstep run(testing::five_nodes(), kEnd, {}, 1);
  run.run();
  EXPECT_EQ(run.conductor().retransmissions(), 0);
  const auto turns = run.conductor().sequencer().turns();
  // A grant reaches five participants; joins, welcomes and the end come once each.
  EXPECT_LT(run.datagrams(), 6 * turns + 200);
}

TEST(LockstepConductor, AParticipantWithOtherArithmeticIsExpelledAndTheReasonNamesIt) {
  std::vector<lockstep_notice_t> notices;
  LockstepConductor::Outputs outputs;
  outputs.notice = [&](const lockstep_notice_t& notice) { notices.push_back(notice); };
  outputs.record = [](const JournalEntry&) {};
  outputs.report = [](const std::string&, const std::string&) {};
  LockstepConductor conductor({.expected = {"a"}, .end = kEnd, .agreement = "scenario=1 arithmetic=2"}, 5,
                              outputs);
  conductor.start();
  lockstep_join_t join{};
  join.incarnation = 9;
  join.participant_name = "a";
  join.scenario_digest = "scenario=1 arithmetic=3";
  conductor.on_join(join, SimTime());
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].notice_kind, lockstep_notice_t::EXPELLED);
  EXPECT_THAT(notices[0].reason,
              AllOf(HasSubstr("arithmetic"), HasSubstr("is '3', not '2'"), Not(HasSubstr("scenario"))));
  EXPECT_THAT(conductor.waiting_for(), Contains("a"));
}

}  // namespace
}  // namespace halocline::conductor
