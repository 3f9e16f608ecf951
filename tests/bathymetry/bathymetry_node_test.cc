#include "bathymetry/bathymetry_node.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include <gtest/gtest.h>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/ray_service.h"
#include "bus/channels.h"
#include "bus/event_log.h"
#include "core/sim_time.h"
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
  ask_and_step({.mode = QueryMode::kExactProfile, .rays = {{{-50, 100, 0}, {1, 0.3, 0}, 900}}});
  ASSERT_EQ(replies_.size(), 1u);  // a NaN would have been refused on the way
  EXPECT_EQ(client_.counters().refused, 0);
  EXPECT_GT(replies_[0].num_samples, 60);
  EXPECT_EQ(replies_[0].sample_valid.front(), 0);
}

}  // namespace
}  // namespace halocline::bathymetry
