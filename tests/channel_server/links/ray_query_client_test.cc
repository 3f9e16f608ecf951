#include "channel_server/links/ray_query_client.h"

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using Kind = RayKind;

constexpr int kPoints = 8;
const AskingRule kRule{
    .rays_per_batch = 128, .batches_in_flight = 2, .batches_per_tick = 3, .answer_deadline = for_s(0.2)};

EchoSurvey survey() { return EchoSurvey({0, 0, 50}, {1000, 0, 50}, kPoints); }

// A service that always answers: depth 100 m, every way free.
void answer(RayQueryClient& asker, const RayQueryBatch& batch) {
  const RayAnswer one = batch.kind == Kind::kDepths ? RayAnswer{RayAnswer::Kind::kHit, 100}
                                                    : RayAnswer{RayAnswer::Kind::kMiss, 0};
  asker.answer(batch.request_id, std::vector<RayAnswer>(batch.rays.size(), one));
}

TEST(RayQueryClient, ASurveyGoesThroughDepthsAndWays) {
  RayQueryClient asker(kRule);
  const auto id = asker.ask_routine(survey());
  EXPECT_EQ(asker.due(), SimTime::at_once());
  const auto depths = asker.take_batches(at_s(0));
  ASSERT_EQ(depths.size(), 1u);
  EXPECT_EQ(depths[0].kind, Kind::kDepths);
  EXPECT_EQ(depths[0].rays.size(), 8u);
  answer(asker, depths[0]);
  const auto ways = asker.take_batches(at_s(0.01));
  ASSERT_EQ(ways.size(), 1u);
  EXPECT_EQ(ways[0].kind, Kind::kWays);
  EXPECT_EQ(ways[0].rays.size(), 16u);
  answer(asker, ways[0]);
  const auto finished = asker.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(finished[0].id, id);
  EXPECT_TRUE(finished[0].answered);
  EXPECT_TRUE(std::get<EchoSurvey>(finished[0].survey).complete());
  EXPECT_EQ(asker.due(), SimTime::never());
}

TEST(RayQueryClient, SurveysShareBatchesUpToTheirSize) {
  RayQueryClient asker(kRule);
  for (int i = 0; i < 20; ++i) asker.ask_routine(survey());
  const auto batches = asker.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(batches[0].rays.size(), 128u);  // 16 surveys of 8 rays
  EXPECT_EQ(batches[1].rays.size(), 32u);
}

TEST(RayQueryClient, OnlySoManyBatchesWaitForAnswers) {
  RayQueryClient asker(kRule);
  for (int i = 0; i < 100; ++i) asker.ask_routine(survey());
  const auto first = asker.take_batches(at_s(0));
  EXPECT_EQ(first.size(), 2u);
  EXPECT_TRUE(asker.take_batches(at_s(0.01)).empty());
  answer(asker, first[0]);
  EXPECT_EQ(asker.take_batches(at_s(0.02)).size(), 1u);
}

TEST(RayQueryClient, OnlySoManyBatchesAreSentATickAndTheRestIsDroppedAndCounted) {
  RayQueryClient asker(kRule);
  for (int i = 0; i < 100; ++i) asker.ask_routine(survey());
  int sent = 0;
  for (auto batches = asker.take_batches(at_s(0)); !batches.empty(); batches = asker.take_batches(at_s(0))) {
    for (const auto& batch : batches) {
      ++sent;
      answer(asker, batch);
    }
  }
  EXPECT_EQ(sent, 3);
  const auto done = asker.take_finished().size();
  EXPECT_EQ(asker.begin_tick().size(), 100 - done);
  EXPECT_EQ(asker.counters().surveys_dropped, static_cast<std::int64_t>(100 - done));
  EXPECT_EQ(asker.due(), SimTime::never());
}

TEST(RayQueryClient, UrgentSurveysGoFirstAndDoNotCount) {
  RayQueryClient asker(kRule);
  for (int i = 0; i < 100; ++i) asker.ask_routine(survey());
  const auto urgent = asker.ask_urgent(survey());
  const auto batches = asker.take_batches(at_s(0));
  EXPECT_EQ(batches[0].rays.size(), 8u);
  answer(asker, batches[0]);
  const auto ways = asker.take_batches(at_s(0));
  EXPECT_EQ(ways[0].rays.size(), 16u);
  answer(asker, ways[0]);
  EXPECT_EQ(asker.take_finished().at(0).id, urgent);
}

TEST(RayQueryClient, ALostBatchIsRepeatedOnceWithItsNumber) {
  RayQueryClient asker(kRule);
  asker.ask_routine(survey());
  const auto sent = asker.take_batches(at_s(0));
  EXPECT_EQ(asker.due(), at_s(0.1));
  const auto repeated = asker.take_batches(at_s(0.1));
  ASSERT_EQ(repeated.size(), 1u);
  EXPECT_EQ(repeated[0].request_id, sent[0].request_id);
  EXPECT_EQ(asker.due(), at_s(0.2));
  answer(asker, repeated[0]);
  EXPECT_FALSE(asker.is_away());
  EXPECT_EQ(asker.counters().batches_repeated, 1);
}

TEST(RayQueryClient, AtTheDeadlineASurveyFailsAndTheServiceIsAway) {
  RayQueryClient asker(kRule);
  asker.ask_routine(survey());
  asker.take_batches(at_s(0));
  asker.take_batches(at_s(0.2));
  EXPECT_TRUE(asker.is_away());
  const auto finished = asker.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_FALSE(finished[0].answered);
}

TEST(RayQueryClient, WhileAwayUrgentSurveysFailAtOnceAndTheServiceIsProbed) {
  RayQueryClient asker(kRule);
  asker.ask_urgent(survey());
  asker.take_batches(at_s(0));
  asker.take_batches(at_s(0.2));
  asker.take_finished();
  const auto id = asker.ask_urgent(survey());
  const auto finished = asker.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(finished[0].id, id);
  EXPECT_FALSE(finished[0].answered);
  const auto probe = asker.take_batches(at_s(1));
  ASSERT_EQ(probe.size(), 1u);
  asker.ask_urgent(survey());
  EXPECT_TRUE(asker.take_batches(at_s(1)).empty());  // one at a time
  asker.take_finished();
  answer(asker, probe[0]);
  EXPECT_FALSE(asker.is_away());
  EXPECT_TRUE(asker.take_finished().empty());  // nobody waited for the probe
}

TEST(RayQueryClient, WhileAwayOneRoutineBatchAtATimeProbes) {
  RayQueryClient asker(kRule);
  for (int i = 0; i < 100; ++i) asker.ask_routine(survey());
  EXPECT_EQ(asker.take_batches(at_s(0)).size(), 2u);
  const auto probe = asker.take_batches(at_s(0.2));
  EXPECT_TRUE(asker.is_away());
  ASSERT_EQ(probe.size(), 1u);
  answer(asker, probe[0]);
  EXPECT_FALSE(asker.is_away());
}

TEST(RayQueryClient, ALateAnswerTellsThatTheServiceIsBack) {
  RayQueryClient asker(kRule);
  asker.ask_routine(survey());
  const auto sent = asker.take_batches(at_s(0));
  asker.take_batches(at_s(0.2));
  ASSERT_TRUE(asker.is_away());
  answer(asker, sent[0]);
  EXPECT_FALSE(asker.is_away());
}

TEST(RayQueryClient, AnswersToNothingAskedAreIgnored) {
  RayQueryClient asker(kRule);
  asker.answer(99, {});
  asker.ask_routine(survey());
  const auto sent = asker.take_batches(at_s(0));
  asker.answer(sent[0].request_id + 1, std::vector<RayAnswer>(8));
  EXPECT_TRUE(asker.take_finished().empty());
  EXPECT_EQ(asker.due(), at_s(0.1));
}

TEST(RayQueryClient, AnAnswerOfAnotherCountAndARefusalAreNoAnswers) {
  RayQueryClient asker(kRule);
  asker.ask_routine(survey());
  asker.answer(asker.take_batches(at_s(0)).at(0).request_id, std::vector<RayAnswer>(7));
  EXPECT_FALSE(asker.take_finished().at(0).answered);
  asker.ask_routine(survey());
  asker.refuse(asker.take_batches(at_s(0)).at(0).request_id);
  EXPECT_FALSE(asker.take_finished().at(0).answered);
  EXPECT_FALSE(asker.is_away());
}

TEST(RayQueryClient, ASurveyWithoutAKnownDepthIsAnsweredWithoutAskingForWays) {
  RayQueryClient asker(kRule);
  asker.ask_routine(survey());
  const auto sent = asker.take_batches(at_s(0));
  asker.answer(sent[0].request_id, std::vector<RayAnswer>(8, {RayAnswer::Kind::kOutside, 0}));
  const auto finished = asker.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_TRUE(finished[0].answered);
  EXPECT_FALSE(std::get<EchoSurvey>(finished[0].survey).complete());
}

TEST(RayQueryClient, ImpossibleRulesAreRefused) {
  EXPECT_THROW(RayQueryClient({.rays_per_batch = 5000}), InvalidArgument);
  EXPECT_THROW(RayQueryClient({.batches_in_flight = 0}), InvalidArgument);
  EXPECT_THROW(RayQueryClient({.answer_deadline = for_s(0)}), InvalidArgument);
}

ProfileSurvey profile(std::int64_t cells_long) {
  return ProfileSurvey({{0, 0}, {cells_long, 0}}, ProfileRule{});
}

TEST(RayQueryClient, AProfileSurveyIsThroughAfterItsDepths) {
  RayQueryClient asker(kRule);
  asker.ask_routine(profile(40));
  const auto depths = asker.take_batches(at_s(0));
  ASSERT_EQ(depths.size(), 1u);
  EXPECT_EQ(depths[0].rays.size(), 17u);  // 400 m, 25 m apart
  answer(asker, depths[0]);
  const auto finished = asker.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_NE(std::get<ProfileSurvey>(finished[0].survey).profile(), nullptr);
  EXPECT_EQ(asker.due(), SimTime::never());
}

TEST(RayQueryClient, ProfilesAndEchoesShareABatchOfDepths) {
  RayQueryClient asker(kRule);
  asker.ask_routine(survey());
  asker.ask_routine(profile(40));
  const auto batches = asker.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 1u);
  EXPECT_EQ(batches[0].rays.size(), 8u + 17u);
  answer(asker, batches[0]);
  EXPECT_EQ(asker.take_batches(at_s(0)).at(0).kind, Kind::kWays);  // the echoes'
}

TEST(RayQueryClient, ASurveyLongerThanABatchGoesWhole) {
  RayQueryClient asker(kRule);
  asker.ask_routine(survey());
  asker.ask_routine(profile(500));
  const auto batches = asker.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(batches[1].rays.size(), 201u);  // kRule allows 128
}

}  // namespace
}  // namespace halocline::channel_server
