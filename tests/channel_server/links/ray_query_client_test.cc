// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/ray_query_client.h"

#include <gtest/gtest.h>

#include "channel_server/links/echo_survey.h"
#include "channel_server/propagation/seabed_map.h"
#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using Kind = RayKind;

constexpr int kPoints = 8;
const RayQueryRule kRule{.rays_per_batch = 128, .batches_in_flight = 2, .answer_deadline = for_s(0.2)};

EchoSurvey survey() { return EchoSurvey({0, 0, 50}, {1000, 0, 50}, kPoints); }

// A service that always answers: depth 100 m, every way free.
void answer(RayQueryClient& rays, const RayQueryBatch& batch) {
  const RayAnswer one = batch.kind == Kind::kWays ? RayAnswer{RayAnswer::Kind::kMiss, 0}
                                                  : RayAnswer{RayAnswer::Kind::kHit, 100};
  const std::size_t a_ray = batch.kind == Kind::kTiles ? 64 : 1;
  rays.answer(batch.request_id, std::vector<RayAnswer>(a_ray * batch.rays.size(), one));
}

TEST(RayQueryClient, ASurveyGoesThroughDepthsAndWays) {
  RayQueryClient rays(kRule);
  const auto id = rays.submit_routine(survey());
  EXPECT_EQ(rays.due(), SimTime::at_once());
  const auto depths = rays.take_batches(at_s(0));
  ASSERT_EQ(depths.size(), 1u);
  EXPECT_EQ(depths[0].kind, Kind::kDepths);
  EXPECT_EQ(depths[0].rays.size(), 8u);
  answer(rays, depths[0]);
  const auto ways = rays.take_batches(at_s(0.01));
  ASSERT_EQ(ways.size(), 1u);
  EXPECT_EQ(ways[0].kind, Kind::kWays);
  EXPECT_EQ(ways[0].rays.size(), 16u);
  answer(rays, ways[0]);
  const auto finished = rays.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(finished[0].id, id);
  EXPECT_TRUE(finished[0].answered);
  EXPECT_TRUE(std::get<EchoSurvey>(finished[0].survey).complete());
  EXPECT_EQ(rays.due(), SimTime::never());
}

TEST(RayQueryClient, SurveysShareBatchesUpToTheirSize) {
  RayQueryClient rays(kRule);
  for (int i = 0; i < 20; ++i) rays.submit_routine(survey());
  const auto batches = rays.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(batches[0].rays.size(), 128u);  // 16 surveys of 8 rays
  EXPECT_EQ(batches[1].rays.size(), 32u);
}

TEST(RayQueryClient, OnlySoManyBatchesWaitForAnswers) {
  RayQueryClient rays(kRule);
  for (int i = 0; i < 100; ++i) rays.submit_routine(survey());
  const auto first = rays.take_batches(at_s(0));
  EXPECT_EQ(first.size(), 2u);
  EXPECT_TRUE(rays.take_batches(at_s(0.01)).empty());
  answer(rays, first[0]);
  EXPECT_EQ(rays.take_batches(at_s(0.02)).size(), 1u);
}

TEST(RayQueryClient, WhatIsNotSentByTheNextTickIsDroppedAndCounted) {
  RayQueryClient rays(kRule);
  for (int i = 0; i < 100; ++i) rays.submit_routine(survey());
  EXPECT_EQ(rays.take_batches(at_s(0)).size(), 2u);  // of 16 surveys each
  EXPECT_EQ(rays.begin_tick().size(), 68u);
  EXPECT_EQ(rays.counters().surveys_dropped, 68);
  EXPECT_TRUE(rays.take_batches(at_s(0)).empty());
}

TEST(RayQueryClient, UrgentSurveysGoFirst) {
  RayQueryClient rays(kRule);
  for (int i = 0; i < 100; ++i) rays.submit_routine(survey());
  const auto urgent = rays.submit_urgent(survey());
  const auto batches = rays.take_batches(at_s(0));
  EXPECT_EQ(batches[0].rays.size(), 8u);
  answer(rays, batches[0]);
  const auto ways = rays.take_batches(at_s(0));
  EXPECT_EQ(ways[0].rays.size(), 16u);
  answer(rays, ways[0]);
  EXPECT_EQ(rays.take_finished().at(0).id, urgent);
}

TEST(RayQueryClient, ALostBatchIsRepeatedWithItsNumberThreeTimes) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  const auto sent = rays.take_batches(at_s(0));
  for (const double at : {0.05, 0.1, 0.15}) {
    EXPECT_EQ(rays.due(), at_s(at));
    const auto repeated = rays.take_batches(at_s(at));
    ASSERT_EQ(repeated.size(), 1u);
    EXPECT_EQ(repeated[0].request_id, sent[0].request_id);
  }
  EXPECT_EQ(rays.due(), at_s(0.2));
  answer(rays, sent[0]);
  EXPECT_FALSE(rays.is_away());
  EXPECT_EQ(rays.counters().batches_repeated, 3);
}

TEST(RayQueryClient, AtTheDeadlineASurveyFailsAndTheServiceIsAway) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  rays.take_batches(at_s(0));
  rays.take_batches(at_s(0.1));
  rays.take_batches(at_s(0.2));
  EXPECT_TRUE(rays.is_away());
  const auto finished = rays.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_FALSE(finished[0].answered);
}

TEST(RayQueryClient, AnOwnerThatWasBusyWaitsForTheAnswerFromItsFirstLookOn) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  rays.take_batches(at_s(0));
  EXPECT_TRUE(rays.take_batches(at_s(5)).empty());
  EXPECT_FALSE(rays.is_away());
  EXPECT_EQ(rays.due(), at_s(5.05));
  EXPECT_EQ(rays.take_batches(at_s(5.05)).size(), 1u);
  rays.take_batches(at_s(5.2));
  EXPECT_TRUE(rays.is_away());
}

TEST(RayQueryClient, WhileAwayUrgentSurveysFailAtOnceAndTheServiceIsProbed) {
  RayQueryClient rays(kRule);
  rays.submit_urgent(survey());
  rays.take_batches(at_s(0));
  rays.take_batches(at_s(0.1));
  rays.take_batches(at_s(0.2));
  rays.take_finished();
  const auto id = rays.submit_urgent(survey());
  const auto finished = rays.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(finished[0].id, id);
  EXPECT_FALSE(finished[0].answered);
  const auto probe = rays.take_batches(at_s(1));
  ASSERT_EQ(probe.size(), 1u);
  rays.submit_urgent(survey());
  EXPECT_TRUE(rays.take_batches(at_s(1)).empty());  // one at a time
  rays.take_finished();
  answer(rays, probe[0]);
  EXPECT_FALSE(rays.is_away());
  EXPECT_TRUE(rays.take_finished().empty());  // nobody waited for the probe
}

TEST(RayQueryClient, WhileAwayOneRoutineBatchAtATimeProbes) {
  RayQueryClient rays(kRule);
  for (int i = 0; i < 100; ++i) rays.submit_routine(survey());
  EXPECT_EQ(rays.take_batches(at_s(0)).size(), 2u);
  rays.take_batches(at_s(0.1));
  const auto probe = rays.take_batches(at_s(0.2));
  EXPECT_TRUE(rays.is_away());
  ASSERT_EQ(probe.size(), 1u);
  answer(rays, probe[0]);
  EXPECT_FALSE(rays.is_away());
}

TEST(RayQueryClient, ALateAnswerShowsThatTheServiceIsBack) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  const auto sent = rays.take_batches(at_s(0));
  rays.take_batches(at_s(0.1));
  rays.take_batches(at_s(0.2));
  ASSERT_TRUE(rays.is_away());
  answer(rays, sent[0]);
  EXPECT_FALSE(rays.is_away());
}

TEST(RayQueryClient, AnswersToNoQueryAreIgnored) {
  RayQueryClient rays(kRule);
  rays.answer(99, {});
  rays.submit_routine(survey());
  const auto sent = rays.take_batches(at_s(0));
  rays.answer(sent[0].request_id + 1, std::vector<RayAnswer>(8));
  EXPECT_TRUE(rays.take_finished().empty());
  EXPECT_EQ(rays.due(), at_s(0.05));
}

TEST(RayQueryClient, AnAnswerOfAnotherCountAndARefusalAreNoAnswers) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  rays.answer(rays.take_batches(at_s(0)).at(0).request_id, std::vector<RayAnswer>(7));
  EXPECT_FALSE(rays.take_finished().at(0).answered);
  rays.submit_routine(survey());
  rays.refuse(rays.take_batches(at_s(0)).at(0).request_id);
  EXPECT_FALSE(rays.take_finished().at(0).answered);
  EXPECT_FALSE(rays.is_away());
}

TEST(RayQueryClient, ASurveyWithoutAKnownDepthIsAnsweredWithoutQueryingWays) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  const auto sent = rays.take_batches(at_s(0));
  rays.answer(sent[0].request_id, std::vector<RayAnswer>(8, {RayAnswer::Kind::kOutside, 0}));
  const auto finished = rays.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_TRUE(finished[0].answered);
  EXPECT_FALSE(std::get<EchoSurvey>(finished[0].survey).complete());
}

TEST(RayQueryClient, ImpossibleRulesAreRefused) {
  EXPECT_THROW(RayQueryClient({.rays_per_batch = 5000}), InvalidArgument);
  EXPECT_THROW(RayQueryClient({.batches_in_flight = 0}), InvalidArgument);
  EXPECT_THROW(RayQueryClient({.answer_deadline = for_s(0)}), InvalidArgument);
}

TEST(RayQueryClient, ATileIsOneRayAndThroughAfterItsDepths) {
  RayQueryClient rays(kRule);
  rays.submit_urgent(TileSurvey({3, -4}, 25));
  const auto tiles = rays.take_batches(at_s(0));
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].kind, Kind::kTiles);
  EXPECT_EQ(tiles[0].spacing_m, 25);
  ASSERT_EQ(tiles[0].rays.size(), 1u);
  EXPECT_EQ(tiles[0].rays[0].origin_ned_m, Vec3(600, -800, 0));
  answer(rays, tiles[0]);
  const auto finished = rays.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(std::get<TileSurvey>(finished[0].survey).z_m(), std::vector<double>(64, 100));
  EXPECT_EQ(rays.due(), SimTime::never());
}

TEST(RayQueryClient, TilesAndEchoesGoInBatchesOfTheirOwn) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  rays.submit_routine(TileSurvey({0, 0}, 25));
  const auto batches = rays.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(batches[0].kind, Kind::kDepths);
  EXPECT_EQ(batches[0].rays.size(), 8u);
  EXPECT_EQ(batches[1].kind, Kind::kTiles);
  answer(rays, batches[0]);
  EXPECT_EQ(rays.take_batches(at_s(0)).at(0).kind, Kind::kWays);  // the echoes'
}

TEST(RayQueryClient, SixtyFourTilesShareABatch) {
  RayQueryClient rays(kRule);
  for (int i = 0; i < 65; ++i) rays.submit_urgent(TileSurvey({i, 0}, 25));
  const auto batches = rays.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(batches[0].rays.size(), 64u);
  EXPECT_EQ(batches[1].rays.size(), 1u);
}

TEST(RayQueryClient, ASurveyLongerThanABatchGoesWhole) {
  RayQueryClient rays(kRule);
  rays.submit_routine(survey());
  rays.submit_routine(EchoSurvey({0, 0, 50}, {1000, 0, 50}, 201));
  const auto batches = rays.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(batches[1].rays.size(), 201u);  // kRule allows 128
}

}  // namespace
}  // namespace halocline::channel_server
