// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/ray_query_client.h"

#include <vector>

#include <gtest/gtest.h>

#include "channel_server/propagation/seabed_map.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

constexpr std::size_t kDepths = 64;  // of a tile

TileSurvey tile(int north = 0) { return TileSurvey({north, 0}, 25); }

void submit(RayQueryClient& rays, int count) {
  for (int i = 0; i < count; ++i) rays.submit(tile(i));
}

// A service that always answers: depth 100 m.
void answer(RayQueryClient& rays, const RayQueryBatch& batch) {
  const std::size_t count = kDepths * batch.origins_ned_m.size();
  rays.answer(batch.request_id, std::vector<RayAnswer>(count, {RayAnswer::Kind::kHit, 100}));
}

// Lets the first batch expire, after which the service is away.
void expire(RayQueryClient& rays) {
  for (const double steady_s : {0.0, 0.1, 0.25}) rays.take_batches(at_s(steady_s));
}

TEST(RayQueryClient, ATileIsThroughAfterItsDepths) {
  RayQueryClient rays;
  rays.submit(TileSurvey({3, -4}, 25));
  EXPECT_EQ(rays.due(), SimTime::at_once());
  const auto batches = rays.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 1u);
  EXPECT_EQ(batches[0].spacing_m, 25);
  EXPECT_EQ(batches[0].origins_ned_m, std::vector<Vec3>{Vec3(600, -800, 0)});
  answer(rays, batches[0]);
  const auto finished = rays.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_TRUE(finished[0].answered);
  EXPECT_EQ(finished[0].tile.z_m(), std::vector<double>(kDepths, 100));
  EXPECT_EQ(rays.due(), SimTime::never());
}

TEST(RayQueryClient, SixtyFourTilesShareABatchAndFourBatchesWait) {
  RayQueryClient rays;
  submit(rays, 300);
  const auto batches = rays.take_batches(at_s(0));
  ASSERT_EQ(batches.size(), 4u);
  for (const RayQueryBatch& batch : batches) EXPECT_EQ(batch.origins_ned_m.size(), 64u);
  EXPECT_TRUE(rays.take_batches(at_s(0.01)).empty());
  answer(rays, batches[0]);
  const auto last = rays.take_batches(at_s(0.02));
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].origins_ned_m.size(), 44u);
}

TEST(RayQueryClient, ALostBatchIsRepeatedWithItsNumberThreeTimes) {
  RayQueryClient rays;
  submit(rays, 1);
  const auto sent = rays.take_batches(at_s(0));
  for (const double at : {0.0625, 0.125, 0.1875}) {
    EXPECT_EQ(rays.due(), at_s(at));
    const auto repeated = rays.take_batches(at_s(at));
    ASSERT_EQ(repeated.size(), 1u);
    EXPECT_EQ(repeated[0].request_id, sent[0].request_id);
  }
  EXPECT_EQ(rays.due(), at_s(0.25));
  answer(rays, sent[0]);
  EXPECT_FALSE(rays.is_away());
  EXPECT_EQ(rays.counters().batches_repeated, 3);
}

TEST(RayQueryClient, AtTheDeadlineWhatWaitsFailsAndTheServiceIsAway) {
  RayQueryClient rays;
  submit(rays, 300);
  expire(rays);
  EXPECT_TRUE(rays.is_away());
  const auto finished = rays.take_finished();
  EXPECT_EQ(finished.size(), 300u);
  for (const auto& one : finished) EXPECT_FALSE(one.answered);
}

TEST(RayQueryClient, AnOwnerThatWasBusyWaitsForTheAnswerFromItsFirstLookOn) {
  RayQueryClient rays;
  submit(rays, 1);
  rays.take_batches(at_s(0));
  EXPECT_TRUE(rays.take_batches(at_s(5)).empty());
  EXPECT_FALSE(rays.is_away());
  EXPECT_EQ(rays.due(), at_s(5.0625));
  EXPECT_EQ(rays.take_batches(at_s(5.0625)).size(), 1u);
  rays.take_batches(at_s(5.25));
  EXPECT_TRUE(rays.is_away());
}

TEST(RayQueryClient, WhileAwayTilesFailAtOnceAndTheServiceIsProbed) {
  RayQueryClient rays;
  submit(rays, 1);
  expire(rays);
  rays.take_finished();
  rays.submit(tile());
  const auto finished = rays.take_finished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_FALSE(finished[0].answered);
  const auto probe = rays.take_batches(at_s(1));
  ASSERT_EQ(probe.size(), 1u);
  rays.submit(tile());
  EXPECT_TRUE(rays.take_batches(at_s(1)).empty());  // one at a time
  rays.take_finished();
  answer(rays, probe[0]);
  EXPECT_FALSE(rays.is_away());
  EXPECT_TRUE(rays.take_finished().empty());  // nobody waited for the probe
}

TEST(RayQueryClient, AProbeNeverAppearsAsFinished) {
  RayQueryClient rays;
  rays.probe(tile());
  const auto sent = rays.take_batches(at_s(0));
  ASSERT_EQ(sent.size(), 1u);
  answer(rays, sent[0]);
  EXPECT_TRUE(rays.take_finished().empty());
}

TEST(RayQueryClient, ALateAnswerShowsThatTheServiceIsBack) {
  RayQueryClient rays;
  submit(rays, 1);
  const auto sent = rays.take_batches(at_s(0));
  expire(rays);
  ASSERT_TRUE(rays.is_away());
  answer(rays, sent[0]);
  EXPECT_FALSE(rays.is_away());
}

TEST(RayQueryClient, AnswersToNoQueryAreIgnored) {
  RayQueryClient rays;
  rays.answer(99, {});
  submit(rays, 1);
  const auto sent = rays.take_batches(at_s(0));
  rays.answer(sent[0].request_id + 1, std::vector<RayAnswer>(kDepths));
  EXPECT_TRUE(rays.take_finished().empty());
  EXPECT_EQ(rays.due(), at_s(0.0625));
}

TEST(RayQueryClient, AnAnswerOfAnotherCountAndARefusalAreNoAnswers) {
  RayQueryClient rays;
  submit(rays, 1);
  rays.answer(rays.take_batches(at_s(0)).at(0).request_id, std::vector<RayAnswer>(7));
  EXPECT_FALSE(rays.take_finished().at(0).answered);
  submit(rays, 1);
  rays.refuse(rays.take_batches(at_s(0)).at(0).request_id);
  EXPECT_FALSE(rays.take_finished().at(0).answered);
  EXPECT_FALSE(rays.is_away());
}

}  // namespace
}  // namespace halocline::channel_server
