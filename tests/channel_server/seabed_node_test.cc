// SPDX-License-Identifier: BSD-3-Clause
// Packets and the bathymetry service: every packet goes over the bottom that lies under it, from the first
// one on, and waits for the answer where that comes after its sound.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/transport/event_log.h"
#include "core/frames.h"
#include "tests/channel_server/node_bench.h"
#include "tests/channel_server/water_models.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::FlatBottom;
using testing::for_s;
using testing::NodeBench;

double hill_z_m(double north_m, double east_m) {
  return 100 - 30 * std::exp(-(north_m * north_m + east_m * east_m) / (2 * 200.0 * 200.0));
}

ServerRules rules_of(double link_rate_hz, int shard = 0, int shards = 1) {
  ServerRules rules;
  rules.link_period = for_s(1 / link_rate_hz);
  rules.medium.shard = {shard, shards};
  return rules;
}

// A channel server along rays, above a hill.
struct Sea {
  explicit Sea(const ServerRules& rules = {})
      : bench(rules, {testing::quick_modem(), {}}, ray_model(testing::even_water(), {}, {})),
        bottom(bench.lcm(), hill_z_m) {}

  // Three vehicles that cross the hill, 30 to 900 m apart, the first of which sends every two seconds.
  void publish(double begin_s, double end_s) {
    for (int tenth = static_cast<int>(10 * begin_s); tenth < static_cast<int>(10 * end_s); ++tenth) {
      const double t = tenth / 10.0;
      bench.state(1, t, Vec3(-400 + 3 * t, 20, 40), {3, 0, 0});
      bench.state(2, t, Vec3(-370 + 3 * t, 20, 42), {3, 0, 0});
      bench.state(3, t, Vec3(450, 100 - 2 * t, 50), {0, -2, 0});
    }
  }

  NodeBench bench;
  FlatBottom bottom;
};

// The bytes of outcomes without what differs between servers.
std::vector<std::string> contents(std::vector<packet_outcome_t> outcomes) {
  std::vector<std::string> all;
  for (packet_outcome_t& outcome : outcomes) {
    outcome.session = outcome.sequence = 0;
    std::string bytes(static_cast<std::size_t>(outcome.getEncodedSize()), '\0');
    outcome.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    all.push_back(std::move(bytes));
  }
  return all;
}

class SeabedNodeTest : public ::testing::Test {
 protected:
  SeabedNodeTest() { bus::set_log_level(bus::LogLevel::kSilent); }
  static std::vector<packet_outcome_t> outcomes_at(double link_rate_hz) {
    Sea sea(rules_of(link_rate_hz));
    for (int second = 0; second < 40; second += 5) {
      sea.publish(second, second + 5);
      for (int i = second; i < second + 5; i += 2) sea.bench.send(1, i + 0.7, i, 8);
      sea.bench.run_to(second + 5 - 1e-3);
    }
    sea.bench.run_to(45);
    return sea.bench.outcomes;
  }
};

TEST_F(SeabedNodeTest, TheFirstPacketGoesOverTheBottomBeforeAnyTable) {
  Sea sea(rules_of(0.0167));
  sea.publish(0, 3);
  sea.bench.send(1, 0.3, 0, 8);
  sea.bench.run_to(2.9);
  EXPECT_TRUE(sea.bench.links.empty());
  ASSERT_EQ(sea.bench.outcomes.size(), 2u);
  for (const auto& outcome : sea.bench.outcomes) {
    EXPECT_EQ(outcome.propagation_used, packet_outcome_t::RAYS);
    EXPECT_GT(outcome.num_paths, 2);
  }
}

TEST_F(SeabedNodeTest, OutcomesDoNotDependOnTheRateOfLinkTables) {
  const auto often = outcomes_at(5), seldom = outcomes_at(0.0167);
  EXPECT_EQ(often.size(), 48u);
  EXPECT_EQ(contents(often), contents(seldom));
  for (const auto& outcome : often) EXPECT_EQ(outcome.propagation_used, packet_outcome_t::RAYS);
}

// Sound needs 20 ms to the second vehicle, the answer 60: the decision waits for it, and so does all after
// it.
TEST_F(SeabedNodeTest, APacketWaitsForAnAnswerThatComesAfterItsSoundAndKeepsItsInstants) {
  Sea prompt(rules_of(0.0167)), slow(rules_of(0.0167));
  for (Sea* sea : {&prompt, &slow}) {
    sea->publish(0, 4);
    sea->bench.send(1, 0.5, 0, 8);
    sea->bench.send(3, 0.52, 1, 8);
  }
  prompt.bench.run_to(3.9);
  slow.bottom.hold();
  slow.bench.run_to(0.56);
  EXPECT_EQ(slow.bench.receipts.size(), 1u);  // of the first packet: the second departs after what waits
  EXPECT_EQ(slow.bench.outcomes.size(), 0u);
  slow.bottom.release();
  slow.bench.run_to(3.9);
  EXPECT_EQ(contents(slow.bench.outcomes), contents(prompt.bench.outcomes));
  EXPECT_EQ(slow.bench.node().counters().late, 0);
}

TEST_F(SeabedNodeTest, ShardsHaveTheSameOutcomesAsOneServer) {
  const auto by_receiver = [](const std::vector<packet_outcome_t>& outcomes, int shard, int shards) {
    std::vector<packet_outcome_t> of_shard;
    for (const auto& outcome : outcomes) {
      if (outcome.receiver_id % shards == shard) of_shard.push_back(outcome);
    }
    return contents(of_shard);
  };
  const auto run = [](Sea& sea) {
    sea.publish(0, 9);
    for (int i = 0; i < 4; ++i) sea.bench.send(1 + i % 3, 0.4 + 2 * i, i, 8);
    sea.bench.run_to(8.9);
    return sea.bench.outcomes;
  };
  Sea one;
  const auto all = run(one);
  ASSERT_EQ(all.size(), 8u);
  for (const int shard : {0, 1}) {
    Sea part(rules_of(1, shard, 2));
    EXPECT_EQ(contents(run(part)), by_receiver(all, shard, 2));
  }
}

TEST_F(SeabedNodeTest, WithoutTheServicePacketsGoStraightOnceItsDeadlineHasPassed) {
  Sea sea(rules_of(0.0167));
  sea.bottom.set_away(true);
  sea.publish(0, 9);
  sea.bench.send(1, 0.5, 0, 8);
  sea.bench.run_to(0.7);
  EXPECT_EQ(sea.bench.outcomes.size(), 0u);
  sea.bench.run_to(3);
  ASSERT_EQ(sea.bench.outcomes.size(), 2u);
  EXPECT_EQ(sea.bench.outcomes[0].propagation_used, packet_outcome_t::STRAIGHT_WITHOUT_BOTTOM);
  sea.bench.send(1, 3.5, 1, 8);  // nothing is waited for any more
  sea.bench.run_to(3.65);
  EXPECT_EQ(sea.bench.outcomes.size(), 3u);
  sea.bottom.set_away(false);
  sea.bench.send(1, 5.5, 2, 8);  // finds out that the service is back
  sea.bench.run_to(6.5);
  sea.bench.send(1, 7.5, 3, 8);
  sea.bench.run_to(8.9);
  ASSERT_EQ(sea.bench.outcomes.size(), 8u);
  EXPECT_EQ(sea.bench.outcomes.back().propagation_used, packet_outcome_t::RAYS);
}

// One packet over 300 m where the bathymetry service knows no place, but its last depth, 100 m; and the first
// row of the table.
std::pair<packet_outcome_t, link_t> beyond_the_terrain(const RayModel& rays) {
  NodeBench bench({}, {testing::quick_modem(), {}}, ray_model(testing::even_water(), rays, {}));
  bus::Bus service(bench.lcm(), {"bathymetry", 11});
  service.subscribe<ray_query_t>(testing::channels::kRayQuery, [&](const ray_query_t& query) {
    ray_reply_t reply{};
    reply.session = 11;
    reply.request_id = query.request_id;
    reply.terrain_version = "none";
    reply.num_rays = 64 * query.num_rays;  // of tiles
    reply.ray_status.assign(static_cast<std::size_t>(reply.num_rays), ray_reply_t::OUTSIDE);
    reply.result_m.assign(static_cast<std::size_t>(reply.num_rays), 100);
    service.publish(testing::channels::kRayReply.of(query.client_name), reply);
  });
  for (double t = 0; t < 3; t += 0.1) {
    bench.state(1, t, {0, 0, 40});
    bench.state(2, t, {300, 0, 40});
  }
  bench.send(1, 0.5, 0, 8);
  bench.run_to(2);
  EXPECT_EQ(bench.outcomes.size(), 1u);
  return {bench.outcomes.at(0), bench.last_table(1).peers.at(0)};
}

TEST_F(SeabedNodeTest, OutsideOfTheTerrainItsLastDepthIsHeldAndNothingWaits) {
  const auto [outcome, row] = beyond_the_terrain({});
  EXPECT_EQ(outcome.propagation_used, packet_outcome_t::RAYS_BEYOND_TERRAIN);
  EXPECT_GT(outcome.num_paths, 1);
  EXPECT_EQ(row.propagation_used, link_t::USED_RAYS_BEYOND_TERRAIN);
  EXPECT_EQ(row.path_state, link_t::PATH_OPEN);
}

TEST_F(SeabedNodeTest, OutsideOfATerrainThatIsNotHeldNoSoundPasses) {
  RayModel rays;
  rays.holds_terrain = false;
  const auto [outcome, row] = beyond_the_terrain(rays);
  EXPECT_EQ(outcome.outcome, packet_outcome_t::NO_TERRAIN);
  EXPECT_EQ(outcome.num_paths, 0);
  EXPECT_EQ(row.path_state, link_t::PATH_NO_TERRAIN);
  EXPECT_EQ(row.delivery_probability, 0);
  EXPECT_FALSE(row.receivable);
}

}  // namespace
}  // namespace halocline::channel_server
