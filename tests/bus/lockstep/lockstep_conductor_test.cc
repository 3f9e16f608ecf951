// The lockstep protocol on a simulated network: whatever the network and death do, the messages of the run and their
// order are those of one process.
#include "bus/lockstep/lockstep_conductor.h"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bus/lockstep/simulated_lockstep.h"

namespace halocline::conductor {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::NetworkRules;
using testing::Said;
using testing::SimulatedLockstep;
using ::testing::StartsWith;

const SimTime kEnd = SimTime::from_seconds(2);

// HALOCLINE_LOCKSTEP_SEEDS: how many random networks each test tries.
unsigned seeds(unsigned usually) {
  const char* asked = std::getenv("HALOCLINE_LOCKSTEP_SEEDS");
  return asked == nullptr ? usually : static_cast<unsigned>(std::atoi(asked));
}

const Said& reference() {
  static const Said said = testing::said_in_one_process(testing::five_nodes(), kEnd);
  return said;
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

void expect_the_same_messages(const NetworkRules& rules, unsigned count) {
  int deaths = 0;
  for (unsigned seed = 0; seed < seeds(count); ++seed) {
    SimulatedLockstep run(testing::five_nodes(), kEnd, rules, seed);
    ASSERT_NO_THROW(run.run()) << "seed " << seed << ", " << last_reports(run);
    const Said& said = run.said();
    const auto differs = std::mismatch(said.begin(), said.end(), reference().begin(), reference().end());
    ASSERT_TRUE(said == reference()) << "seed " << seed << ": differs from message "
                                     << differs.first - said.begin() << " on, of " << said.size() << " and "
                                     << reference().size();
    deaths += run.deaths();
  }
  if (rules.participant_deaths_per_s + rules.conductor_deaths_per_s > 0) {
    EXPECT_GT(deaths, static_cast<int>(seeds(count))) << "a test of deaths needs deaths";
  }
}

TEST(LockstepConductor, SaysWhatOneProcessSays) {
  EXPECT_GT(reference().size(), 150u);
  expect_the_same_messages({}, 20);
}

TEST(LockstepConductor, SaysTheSameWithoutWindows) { expect_the_same_messages({.windows = false}, 20); }

TEST(LockstepConductor, SaysTheSameWithParticipantsInItsOwnProcess) {
  expect_the_same_messages({.loss = 0.1, .conductor_deaths_per_s = 5, .local = 2}, 30);
}

TEST(LockstepConductor, SaysTheSameWhenDatagramsAreLostDoubledAndOvertaken) {
  for (const double loss : {0.01, 0.05, 0.2, 0.5}) {
    expect_the_same_messages(
        {.loss = loss, .doubling = 0.2, .longest_delay = SimDuration::from_milliseconds(20)}, 20);
  }
}

TEST(LockstepConductor, SaysTheSameWhenParticipantsDieAndReturn) {
  expect_the_same_messages({.loss = 0.05, .doubling = 0.05, .participant_deaths_per_s = 30}, 60);
}

TEST(LockstepConductor, SaysTheSameWhenTheConductorDiesAndReturns) {
  expect_the_same_messages({.loss = 0.05, .doubling = 0.05, .conductor_deaths_per_s = 20}, 60);
}

TEST(LockstepConductor, SaysTheSameWhenAllDieAndReturn) {
  expect_the_same_messages({.loss = 0.1,
                            .doubling = 0.1,
                            .longest_delay = SimDuration::from_milliseconds(5),
                            .participant_deaths_per_s = 20,
                            .conductor_deaths_per_s = 20},
                           150);
}

TEST(LockstepConductor, WindowsSaveExchanges) {
  SimulatedLockstep with(testing::five_nodes(), kEnd, {}, 1);
  SimulatedLockstep without(testing::five_nodes(), kEnd, {.windows = false}, 1);
  with.run();
  without.run();
  EXPECT_LT(with.conductor().sequencer().rounds(), without.conductor().sequencer().rounds());
}

TEST(LockstepConductor, WaitsForOneThatIsDeadWhenThatIsThePolicy) {
  SimulatedLockstep run(testing::five_nodes(), kEnd, {.dies_for_good_after = 10}, 1);
  EXPECT_THROW(run.run(SimDuration::from_seconds(30)), std::runtime_error);
  EXPECT_THAT(run.conductor().waiting_for(), Contains("server"));
}

TEST(LockstepConductor, DropsOneThatIsDeadAfterTheTimeSaidAndSaysSo) {
  const NetworkRules rules{.drop_after = SimDuration::from_seconds(2), .dies_for_good_after = 10};
  SimulatedLockstep run(testing::five_nodes(), kEnd, rules, 1);
  run.run();
  EXPECT_THAT(run.reports(), Contains(StartsWith("dropped participant=server")));
  EXPECT_GT(run.said().size(), reference().size() / 2);
}

TEST(LockstepConductor, OneThatWasDroppedMayComeBackAndGoesOn) {
  const NetworkRules rules{.drop_after = SimDuration::from_seconds(1), .dies_for_good_after = -1};
  SimulatedLockstep run(testing::five_nodes(), SimTime::from_seconds(40), rules, 1);
  int phase = 0;
  run.between_events = [&](SimulatedLockstep& now) {
    const bool dropped = !now.conductor().sequencer().takes_part("server");
    const auto turns = now.conductor().sequencer().turns_taken("server");
    if (phase == 0 && turns >= 10) {
      now.kill_participant(4);
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

// A fixed bug: its new life has all turns but the one that the round already has an answer to.
TEST(LockstepConductor, OneThatDiesBetweenItsAnswerAndTheOthersComesBackWithoutMissingThatTurn) {
  SimulatedLockstep run(testing::five_nodes(), kEnd, {}, 1);
  bool died = false;
  run.between_events = [&](SimulatedLockstep& now) {
    const auto& round = now.conductor().sequencer().round();
    const auto missing = now.conductor().waiting_for();
    if (died || round.size() < 2 || missing.size() != 1 || missing[0] != "mover-b") return;
    now.kill_participant(1);
    now.kill_participant(2);
    now.start_participant(1);
    now.start_participant(2);
    died = true;
  };
  run.run(SimDuration::from_seconds(30));
  EXPECT_TRUE(died);
  EXPECT_TRUE(run.said() == reference());
}

TEST(LockstepConductor, OneThatAsksToLeaveSaysGoodbyeAndTheOthersGoOn) {
  SimulatedLockstep run(testing::five_nodes(), SimTime::from_seconds(20), {.loss = 0.1}, 1);
  bool asked = false;
  run.between_events = [&](SimulatedLockstep& now) {
    if (asked || now.conductor().sequencer().turns_taken("pilot") < 10) return;
    now.participant(3)->ask_to_leave();
    asked = true;
  };
  run.run();
  EXPECT_EQ(run.participant(3)->state(), bus::LockstepParticipant::State::kOver);
  EXPECT_THAT(run.reports(), Contains(StartsWith("leaves participant=pilot")));
  EXPECT_THAT(run.said().back(), HasSubstr("STATUS.server"));
}

TEST(LockstepConductor, ALateJoinerTakesPartFromTheInstantSaid) {
  auto cast = testing::five_nodes();
  SimulatedLockstep run(cast, SimTime::from_seconds(20), {.loss = 0.05}, 1);
  lcm::LCM memq("memq://");
  testing::ChattyNode late(memq, "late", bus::Stage::kClients, SimDuration::from_milliseconds(40), {"pilot"},
                           "pilot");
  bus::LockstepTurns turns(memq, late);
  bool joined = false;
  run.between_events = [&](SimulatedLockstep& now) {
    if (joined || now.conductor().sequencer().turns_taken("pilot") < 10) return;
    now.conductor().add_local(turns.introduction(), [&](const lockstep_turn_t& t) { return turns.take(t); });
    joined = true;
  };
  run.run();
  EXPECT_THAT(run.reports(), Contains(StartsWith("joined participant=late t=")));
  EXPECT_THAT(run.said(), Contains(HasSubstr("SAY.late")));
}

TEST(LockstepConductor, TheCostOfARoundIsAGrantAndAnAnswerEach) {
  SimulatedLockstep run(testing::five_nodes(), kEnd, {}, 1);
  run.run();
  EXPECT_EQ(run.conductor().repetitions(), 0);
  const auto turns = run.conductor().sequencer().turns();
  // A grant reaches five ears; joins, welcomes and farewells come once each.
  EXPECT_LT(run.datagrams(), 6 * turns + 200);
}

TEST(LockstepConductor, AParticipantOfAnotherScenarioIsPutOut) {
  std::vector<lockstep_notice_t> notices;
  LockstepConductor::Mouth mouth;
  mouth.notice = [&](const lockstep_notice_t& notice) { notices.push_back(notice); };
  mouth.record = [](const JournalEntry&) {};
  mouth.report = [](const std::string&, const std::string&) {};
  LockstepConductor conductor({.expected = {"a"}, .end = kEnd, .scenario_digest = "this"}, 5, mouth);
  conductor.start();
  lockstep_join_t join{};
  join.incarnation = 9;
  join.participant_name = "a";
  join.scenario_digest = "that";
  conductor.on_join(join, SimTime());
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].notice_kind, lockstep_notice_t::EXPELLED);
  EXPECT_THAT(conductor.waiting_for(), Contains("a"));
}

}  // namespace
}  // namespace halocline::conductor
