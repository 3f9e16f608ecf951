// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/bathymetry_node.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include <gtest/gtest.h>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/ray_service.h"
#include "bus/messages/channels.h"
#include "bus/transport/event_log.h"
#include "core/sim_time.h"
#include "tests/bathymetry/ray_queries.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;

// A node and a client on one memory bus.
class BathymetryNodeTest : public ::testing::Test {
 protected:
  BathymetryNodeTest() {
    bus::set_log_level(bus::LogLevel::kSilent);
    client_.subscribe<ray_reply_t>(bus::channels::kRayReply,
                                   [this](std::string_view name, const ray_reply_t& reply) {
                                     heard_on_.emplace_back(name);
                                     replies_.push_back(reply);
                                   });
    client_.subscribe<terrain_tile_t>(bus::channels::kTerrain,
                                      [this](const terrain_tile_t& tile) { overviews_.push_back(tile); });
    client_.subscribe<terrain_tile_t>(bus::channels::kTerrainReply,
                                      [this](std::string_view name, const terrain_tile_t& tile) {
                                        heard_on_.emplace_back(name);
                                        tiles_.push_back(tile);
                                      });
  }

  // Delivers all that waits on the bus.
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  void step() { node_.step({SimTime::from_seconds(1), SimTime::from_seconds(1), false}); }
  void query(const RayBatch& batch, std::int64_t request_id = 1, const std::string& name = "alpha") {
    client_.publish(bus::channels::kRayQuery,
                    to_message({5'000'000, name, request_id}, batch, {100, 100, 0}));
    drain();
  }
  void query_tile(double north_m, double spacing_m, std::int32_t rows, std::int32_t columns,
                  std::int64_t request_id = 1, const std::string& name = "alpha") {
    terrain_query_t query{};
    query.utime = 5'000'000;
    query.client_name = name;
    query.request_id = request_id;
    query.corner_north_m = north_m;
    query.post_spacing_m = spacing_m;
    query.requested_rows = rows;
    query.requested_columns = columns;
    client_.publish(bus::channels::kTerrainQuery, query);
    drain();
  }
  void ask_and_step(const RayBatch& batch) {
    query(batch);
    step();
    drain();
  }

  lcm::LCM lcm_{"memq://"};
  std::shared_ptr<const Terrain> terrain_ = std::make_shared<const Terrain>(testing::rugged_grid(65));
  BathymetryNode node_{lcm_, {"bathymetry", 77}, terrain_, "rugged"};
  bus::Bus client_{lcm_, {"alpha", 1}};
  std::vector<std::string> heard_on_;
  std::vector<ray_reply_t> replies_;
  std::vector<terrain_tile_t> overviews_, tiles_;
};

const Ray kDown{{300, 200, 10}, {0, 0, 1}, 1000};

TEST_F(BathymetryNodeTest, AnswersTheClientFromItsTerrain) {
  ask_and_step({.rays = {kDown}});
  ASSERT_EQ(replies_.size(), 1u);
  EXPECT_EQ(heard_on_.front(), "alpha");
  const ray_reply_t& reply = replies_.front();
  EXPECT_EQ(reply.reply_status, ray_reply_t::OK);
  EXPECT_EQ(reply.ray_status, std::vector<std::int8_t>{ray_reply_t::HIT});
  EXPECT_NEAR(reply.result_m[0], terrain_->depth_at(300, 200).z_m - 10, tolerance(1e-9));
}

TEST_F(BathymetryNodeTest, EchoesTheQueryAndNamesItselfAndItsTerrain) {
  ask_and_step({.rays = {kDown}});
  ASSERT_EQ(replies_.size(), 1u);
  EXPECT_EQ(replies_[0].utime, 5'000'000);
  EXPECT_EQ(replies_[0].request_id, 1);
  EXPECT_EQ(replies_[0].session, 77);
  EXPECT_EQ(replies_[0].terrain_version, version_text(terrain_->version()));
}

TEST_F(BathymetryNodeTest, IsDueAtOnceWhileAQueryWaitsAlsoBeforeTheTimeIsKnown) {
  step();
  EXPECT_NE(node_.due().sim, SimTime::at_once());
  query({.rays = {kDown}});
  EXPECT_EQ(node_.due().sim, SimTime::at_once());
  step();
  EXPECT_NE(node_.due().sim, SimTime::at_once());
}

TEST_F(BathymetryNodeTest, HandlersOnlyStore) {
  query({.rays = {kDown}});
  EXPECT_TRUE(replies_.empty());
}

TEST_F(BathymetryNodeTest, AnswersInTheOrderOfTheQueries) {
  for (std::int64_t id = 1; id <= 5; ++id) query({.rays = {kDown}}, id);
  step();
  drain();
  ASSERT_EQ(replies_.size(), 5u);
  for (std::size_t n = 0; n < 5; ++n) EXPECT_EQ(replies_[n].request_id, static_cast<std::int64_t>(n) + 1);
}

TEST_F(BathymetryNodeTest, ARepeatedQueryThatStillWaitsIsAnsweredOnce) {
  query({.rays = {kDown}}, 9);
  query({.rays = {kDown}}, 9);
  query({.rays = {kDown}}, 9, "beta");
  step();
  drain();
  EXPECT_EQ(replies_.size(), 2u);
}

TEST_F(BathymetryNodeTest, AQueryRepeatedAfterItsReplyGetsTheSameReply) {
  ask_and_step({.rays = {kDown}});
  ask_and_step({.rays = {kDown}});
  ASSERT_EQ(replies_.size(), 2u);
  EXPECT_EQ(replies_[0].result_m, replies_[1].result_m);
}

TEST_F(BathymetryNodeTest, RefusesMoreThanTheCapWhole) {
  ask_and_step({.rays = std::vector<Ray>(kMaxRays + 1, kDown)});
  ASSERT_EQ(replies_.size(), 1u);
  EXPECT_EQ(replies_[0].reply_status, ray_reply_t::REFUSED_TOO_MANY);
  EXPECT_EQ(replies_[0].num_rays, 0);
  EXPECT_FALSE(replies_[0].refusal.empty());
}

TEST_F(BathymetryNodeTest, RefusesForAnotherTerrainAndNamesItsOwn) {
  ask_and_step({.expected_terrain = "another", .rays = {kDown}});
  ASSERT_EQ(replies_.size(), 1u);
  EXPECT_EQ(replies_[0].reply_status, ray_reply_t::REFUSED_OTHER_TERRAIN);
  EXPECT_EQ(replies_[0].terrain_version, version_text(terrain_->version()));
}

TEST_F(BathymetryNodeTest, JudgesRaysOneByOne) {
  Ray bad = kDown;
  bad.direction = {std::numeric_limits<double>::quiet_NaN(), 0, 1};
  ask_and_step({.rays = {kDown, bad, kDown}});
  ASSERT_EQ(replies_.size(), 1u);
  const std::vector<std::int8_t> expected{ray_reply_t::HIT, ray_reply_t::BAD_INPUT, ray_reply_t::HIT};
  EXPECT_EQ(replies_[0].ray_status, expected);
}

TEST_F(BathymetryNodeTest, ACorruptQueryIsCountedAndNotAnswered) {
  ray_query_t query = to_message({0, "no valid name!", 1}, {.rays = {kDown}}, Vec3::Zero());
  client_.publish(bus::channels::kRayQuery, query);
  const std::uint8_t rubbish[] = {1, 2, 3};
  lcm_.publish("RAY_QUERY", rubbish, sizeof rubbish);
  drain();
  step();
  drain();
  EXPECT_TRUE(replies_.empty());
  EXPECT_EQ(node_.counters().refused, 2);
}

TEST_F(BathymetryNodeTest, RefusesQueriesBeyondWhatMayWait) {
  for (std::size_t n = 0; n <= BathymetryNode::kMaxWaiting; ++n) {
    query({.mode = QueryMode::kDepth, .rays = {kDown}}, static_cast<std::int64_t>(n));
  }
  EXPECT_EQ(node_.counters().refused, 1);
  step();
  drain();
  EXPECT_EQ(replies_.size(), BathymetryNode::kMaxWaiting);
}

TEST_F(BathymetryNodeTest, RepliesPassTheChecksOfTheBus) {
  ask_and_step(
      {.mode = QueryMode::kDepthTiles, .sample_spacing_m = 10, .rays = {{{-50, 100, 0}, {0, 0, 1}, 1}}});
  ASSERT_EQ(replies_.size(), 1u);  // a NaN would have been refused on the way
  EXPECT_EQ(client_.counters().refused, 0);
  EXPECT_EQ(replies_[0].num_rays, 64);
  EXPECT_EQ(replies_[0].ray_status.front(), ray_reply_t::OUTSIDE);
}

std::size_t size_of(const terrain_tile_t& tile) { return static_cast<std::size_t>(tile.getEncodedSize()); }
constexpr std::size_t kPacedMessage = 60'000;  // docs/architecture.md

TEST_F(BathymetryNodeTest, TheWholeTerrainIsPublishedOnceWhenTheTimeIsKnown) {
  step();  // the time is not known
  drain();
  EXPECT_TRUE(overviews_.empty());
  EXPECT_LT(node_.due().sim, SimTime::from_seconds(-1e9));
  for (const double t : {3.0, 4.0, 100.0}) node_.step({SimTime::from_seconds(t), SimTime::from_seconds(t)});
  drain();
  ASSERT_EQ(overviews_.size(), 1u);
  const terrain_tile_t& tile = overviews_[0];
  EXPECT_EQ(tile.utime, 3'000'000);
  EXPECT_EQ(tile.session, 77);
  EXPECT_EQ(tile.tile_status, terrain_tile_t::OK);
  EXPECT_EQ(tile.terrain_version, version_text(terrain_->version()));
  EXPECT_EQ(tile.tile_rows, 65);
  EXPECT_EQ(tile.tile_columns, 65);
  EXPECT_EQ(tile.post_spacing_m, 10);
  EXPECT_EQ(tile.finest_spacing_m, 10);
  EXPECT_EQ(tile.extent_south_m, 0);
  EXPECT_EQ(tile.extent_north_m, 640);
  EXPECT_EQ(tile.seabed_z_m[66], static_cast<float>(terrain_->depth_at(10, 10).z_m));
  EXPECT_EQ(node_.due().sim, SimTime::never());
}

TEST_F(BathymetryNodeTest, AnotherRunGetsTheTerrainAnew) {
  node_.step({SimTime::from_seconds(3), SimTime::from_seconds(3)});
  node_.restart({SimTime(), SimTime::from_seconds(4)});
  node_.step({SimTime(), SimTime::from_seconds(4)});
  drain();
  ASSERT_EQ(overviews_.size(), 2u);
  EXPECT_EQ(overviews_[1].utime, 0);
}

TEST_F(BathymetryNodeTest, AnswersATileToItsClientAlsoBeforeTheTimeIsKnown) {
  query_tile(100, 2.5, 7, 9, 42);
  EXPECT_EQ(node_.due().sim, SimTime::at_once());
  step();
  drain();
  ASSERT_EQ(tiles_.size(), 1u);
  EXPECT_EQ(heard_on_.front(), "alpha");
  EXPECT_EQ(tiles_[0].utime, 5'000'000);
  EXPECT_EQ(tiles_[0].request_id, 42);
  EXPECT_EQ(tiles_[0].num_posts, 63);
  EXPECT_EQ(tiles_[0].tile_south_m, 100);
  EXPECT_EQ(tiles_[0].seabed_z_m[10], static_cast<float>(terrain_->depth_at(102.5, 2.5).z_m));
}

TEST_F(BathymetryNodeTest, ARefusedTileNamesFieldAndLimitAndHasNoPosts) {
  query_tile(0, 1, 30'000, 30'000);
  query_tile(std::numeric_limits<double>::quiet_NaN(), 1, 3, 3, 2);
  step();
  drain();
  ASSERT_EQ(tiles_.size(), 2u);
  EXPECT_EQ(tiles_[0].tile_status, terrain_tile_t::REFUSED);
  EXPECT_EQ(tiles_[0].refusal, "requested_rows is 30000; allowed is 1 to 10000");
  EXPECT_EQ(tiles_[0].num_posts, 0);
  EXPECT_EQ(tiles_[1].refusal,
            "corner_north_m is nan; allowed is -2 to 640, where the tile meets the terrain");
  EXPECT_EQ(tiles_[1].extent_north_m, 640);  // a client learns where to look
}

TEST_F(BathymetryNodeTest, TheLargestTilesStayBelowAPacedMessage) {
  query_tile(0, 1, 100, 100);
  step();
  drain();
  ASSERT_EQ(tiles_.size(), 1u);
  EXPECT_EQ(tiles_[0].num_posts, kMaxPosts);
  EXPECT_LT(size_of(tiles_[0]), kPacedMessage);
}

TEST_F(BathymetryNodeTest, AFloodOfTilesIsBoundedAndARepetitionAnsweredOnce) {
  for (std::size_t n = 0; n < 3 * BathymetryNode::kMaxTilesWaiting; ++n)
    query_tile(0, 1, 100, 100, static_cast<std::int64_t>(n));
  query_tile(0, 1, 100, 100, 0);
  EXPECT_EQ(node_.counters().refused, static_cast<std::int64_t>(2 * BathymetryNode::kMaxTilesWaiting));
  step();
  drain();
  EXPECT_EQ(tiles_.size(), BathymetryNode::kMaxTilesWaiting);
}

TEST_F(BathymetryNodeTest, AForgedNameGetsNoTile) {
  query_tile(0, 1, 3, 3, 1, "STATE.auv-1");
  query_tile(0, 1, 3, 3, 1, "");
  step();
  drain();
  EXPECT_TRUE(tiles_.empty());
  EXPECT_EQ(node_.counters().refused, 2);
}

}  // namespace
}  // namespace halocline::bathymetry
