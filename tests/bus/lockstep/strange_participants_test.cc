// SPDX-License-Identifier: BSD-3-Clause
// What a participant should not say, and what a journal should not hold: the run goes on, or says why it does
// not.
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/journal_replay.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/sequencer.h"
#include "bus/messages/channel_pattern.h"
#include "bus/messages/message_codec.h"
#include "core/sim_time.h"

namespace halocline::conductor {
namespace {

constexpr std::int64_t kRun = 5, kMillisecond = 1'000'000;

lockstep_join_t join_of(const std::string& name, std::int64_t incarnation,
                        const std::vector<std::string>& subscriptions) {
  lockstep_join_t join{};
  join.participant_name = name;
  join.incarnation = incarnation;
  join.step_stage = 2;
  join.subscriptions = subscriptions;
  join.num_subscriptions = static_cast<std::int32_t>(subscriptions.size());
  join.only_stores.assign(subscriptions.size(), 0);
  return join;
}

// A conductor that expects "a" and "b", and what it sends.
struct Bench {
  Bench() : conductor({.expected = {"a", "b"}, .end = SimTime::from_seconds(2)}, kRun, outputs()) {
    conductor.start();
  }

  LockstepConductor::Outputs outputs() {
    return {
        .grant = [this](const std::string&, const lockstep_grant_t& grant) { grants.push_back(grant); },
        .notice = [this](const lockstep_notice_t& notice) { notices.push_back(notice); },
        .record = [](const JournalEntry&) {},
        .publish = [this](const lockstep_message_t& message) { published.push_back(message.channel_name); },
        .report = [](const std::string&, const std::string&) {}};
  }
  void join(const std::string& name, std::int64_t incarnation,
            const std::vector<std::string>& subscriptions = {}) {
    conductor.on_join(join_of(name, incarnation, subscriptions), SimTime());
  }
  // Both take part, and have the first turn.
  void begin() {
    join("a", 2);
    join("b", 3);
    ASSERT_EQ(grants.size(), 1u);
  }
  void answer(std::int64_t incarnation, const lockstep_result_t& result) {
    lockstep_answer_t answer{};
    answer.run_id = kRun;
    answer.incarnation = incarnation;
    answer.turn_number = 1;
    answer.slice_count = 1;
    answer.slice_bytes = bus::encoded(result);
    answer.num_slice_bytes = static_cast<std::int32_t>(answer.slice_bytes.size());
    conductor.on_answer(answer, SimTime());
  }

  std::vector<lockstep_grant_t> grants;
  std::vector<lockstep_notice_t> notices;
  std::vector<std::string> published;
  LockstepConductor conductor;
};

// Of the first turn, at 0 s.
lockstep_result_t result_of(const std::string& name) {
  lockstep_result_t result{};
  result.participant_name = name;
  result.num_steps = 1;
  result.next_due_ns = 100 * kMillisecond;
  return result;
}

TEST(StrangeParticipants, AJoinThatCannotBeFollowedIsExpelled) {
  Bench bench;
  bench.join("a", 2, {"STATE\\.("});
  bench.join("a", 3, {std::string(10'000, '(')});
  lockstep_join_t join = join_of("a", 4, {});
  join.step_stage = std::numeric_limits<std::int32_t>::max();
  bench.conductor.on_join(join, SimTime());
  ASSERT_EQ(bench.notices.size(), 3u);
  for (const lockstep_notice_t& notice : bench.notices) {
    EXPECT_EQ(notice.notice_kind, lockstep_notice_t::EXPELLED);
    EXPECT_NE(notice.reason, "");
  }
  EXPECT_THAT(bench.conductor.waiting_for(), ::testing::Contains("a"));
}

// With backtracking the conductor would try 2^60 ways for the first output of another.
TEST(StrangeParticipants, AnExpressionThatBacktracksHoldsNobodyUp) {
  Bench bench;
  bench.join("a", 2, {"(a*)*b"});
  bench.join("b", 3);
  lockstep_result_t result = result_of("b");
  result.outputs.resize(1);
  result.num_outputs = 1;
  result.outputs[0].channel_name = std::string(60, 'a');
  bench.answer(3, result);
  bench.answer(2, result_of("a"));
  EXPECT_THAT(bench.published, ::testing::ElementsAre(std::string(60, 'a')));
}

// Of "(STATE\.a|DVL\.b)" the part before the dot is no expression: whoever is told to stop there would end.
TEST(StrangeParticipants, WhatEndsALookaheadIsAnExpressionWhateverSomeSubscribeTo) {
  Bench bench;
  bench.join("a", 2, {"(STATE\\.a|DVL\\.b)", "GPS\\.a"});
  bench.join("b", 3);
  std::vector<std::string> stopping;
  for (const lockstep_grant_t& grant : bench.grants) {
    const auto turns = bus::decoded_list<lockstep_turn_t>(grant.slice_bytes);
    ASSERT_TRUE(turns.has_value());
    for (const lockstep_turn_t& turn : *turns)
      stopping.insert(stopping.end(), turn.stopping_channels.begin(), turn.stopping_channels.end());
  }
  EXPECT_THAT(stopping, ::testing::Contains("GPS\\..*"));
  EXPECT_THAT(stopping, ::testing::Contains("(STATE\\.a|DVL\\.b)"));
  for (const std::string& expression : stopping)
    EXPECT_NO_THROW(bus::ChannelPattern{expression}) << expression;
}

TEST(StrangeParticipants, AnAnswerThatCannotComeOfItsTurnIsIgnoredAndTheTrueOneCounts) {
  const std::vector<std::function<void(lockstep_result_t&)>> strange{
      [](auto& result) { result.num_steps = Sequencer::kDropped; },
      [](auto& result) { result.reached_ns = -1; },
      [](auto& result) { result.reached_ns = std::numeric_limits<std::int64_t>::max(); },
      [](auto& result) { result.outputs[0].instant_ns = -1; },
      [](auto& result) { result.outputs[0].instant_ns = 50 * kMillisecond; }};
  for (std::size_t i = 0; i < strange.size(); ++i) {
    Bench bench;
    bench.begin();
    lockstep_result_t result = result_of("a");
    result.outputs.resize(2);
    result.num_outputs = 2;
    result.outputs[0].channel_name = "X";
    result.outputs[1].channel_name = "Y";
    lockstep_result_t other = result;
    strange[i](other);
    bench.answer(2, other);
    EXPECT_THAT(bench.conductor.waiting_for(), ::testing::ElementsAre("a", "b")) << i;
    bench.answer(2, result);
    EXPECT_THAT(bench.conductor.waiting_for(), ::testing::ElementsAre("b")) << i;
    bench.answer(3, result_of("b"));
    EXPECT_THAT(bench.published, ::testing::ElementsAre("X", "Y")) << i;
  }
}

bus::Bytes text(const std::string& content) { return {content.begin(), content.end()}; }

TEST(StrangeJournals, AnEntryThatNoConductorWroteIsRefused) {
  const auto round_of = [](const lockstep_result_t& result) {
    return JournalEntry{EntryKind::kRound, bus::encoded_list<lockstep_result_t>(std::vector{result})};
  };
  lockstep_join_t never_due = join_of("a", 2, {});
  never_due.next_due_ns = SimTime::never().nanoseconds();
  const JournalEntry joined{EntryKind::kJoin, bus::encoded(never_due)};
  const std::vector<std::vector<JournalEntry>> journals{
      {{EntryKind::kRun, text("x")}},
      {{EntryKind::kRun, text("99999999999999999999")}},
      {{EntryKind::kEnd, text("")}},
      {{EntryKind::kJoin, text("x")}},
      {{EntryKind::kRound, {}}},
      {round_of(result_of("nobody"))},
      {joined, round_of(result_of("nobody"))},
      {joined, round_of(result_of("a"))},  // it is never due
      {{static_cast<EntryKind>(77), {}}}};
  for (std::size_t i = 0; i < journals.size(); ++i) {
    Sequencer sequencer([](const lockstep_message_t&) {});
    EXPECT_THROW(replay_journal(journals[i], "", sequencer), std::runtime_error) << i;
  }
}

}  // namespace
}  // namespace halocline::conductor
