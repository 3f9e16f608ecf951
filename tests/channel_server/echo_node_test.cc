// SPDX-License-Identifier: BSD-3-Clause
// The channel server with straight paths and the bathymetry service: echoes in tables and answers, and the
// service away and back.
#include <cstdint>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/transport/event_log.h"
#include "channel_server/seabed_client.h"
#include "channel_server/water_model.h"
#include "core/sim_time.h"
#include "tests/channel_server/link_queries.h"
#include "tests/channel_server/node_bench.h"

namespace halocline::channel_server {
namespace {

using testing::at;
using testing::at_s;
using testing::FlatBottom;
using testing::for_s;
using ::testing::HasSubstr;
using testing::NodeBench;

class EchoNodeTest : public ::testing::Test {
 protected:
  EchoNodeTest() { bus::set_log_level(bus::LogLevel::kSilent); }
  void two_at_rest(double end_s = 10) {
    for (double t = 0; t <= end_s; t += 0.5) {
      bench_.state(1, t, {0, 0, 50});
      bench_.state(2, t, {500, 0, 50});
    }
  }
  int multipath() { return bench_.last_table(1).peers.at(0).multipath; }
  void publish_query(std::int64_t request_id, const std::vector<std::pair<link_end_t, link_end_t>>& ends) {
    bench_.bus().publish("LINK_QUERY", testing::link_query(ends, request_id));
  }

  NodeBench bench_{{}, {testing::quick_modem(), {}}, straight_model(testing::even_water())};
};

TEST_F(EchoNodeTest, TheFirstRowKnowsTheEchoes) {
  FlatBottom bottom(bench_.lcm(), 100);
  two_at_rest();
  bench_.run_to(1);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, AVehicleAtRestIsQueriedOnce) {
  FlatBottom bottom(bench_.lcm(), 100);
  two_at_rest();
  bench_.run_to(14);
  ASSERT_EQ(bottom.queries().size(), 1u);
  EXPECT_EQ(bottom.queries()[0].query_mode, ray_query_t::DEPTH_TILES);
}

TEST_F(EchoNodeTest, WithoutTheServiceLinksComeAllTheSameAndItRecoversByItself) {
  FlatBottom bottom(bench_.lcm(), 100);
  bottom.set_away(true);
  two_at_rest();
  bench_.run_to(5);
  EXPECT_EQ(bench_.last_table(1).utime, 5'000'000);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_UNKNOWN);
  EXPECT_THAT(bench_.statuses.back().message.status_text, HasSubstr("bathymetry away"));
  bottom.set_away(false);
  bench_.run_to(8);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, TheServiceLostAfterwardsIsNotMissedOverAKnownSeabed) {
  FlatBottom bottom(bench_.lcm(), 100);
  for (double t = 0; t <= 10; t += 0.5) {
    bench_.state(1, t, {0, 0, 50});
    bench_.state(2, t, {500 + 4 * t, 0, 50}, {4, 0, 0});
  }
  bench_.run_to(3);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
  bottom.set_away(true);
  bench_.run_to(10);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, ARecordedReplyIsNotTakenForTheServices) {
  two_at_rest();
  ray_reply_t recorded{};
  recorded.request_id = 1;
  recorded.num_rays = 64;
  recorded.ray_status.assign(64, ray_reply_t::HIT);
  recorded.result_m.assign(64, 60);
  for (int second = 1; second <= 5; ++second) {
    bench_.bus().publish("RAY_REPLY." + SeabedClient::client_name(NodeBench::kSession + 1), recorded);
    bench_.run_to(second);
  }
  EXPECT_EQ(multipath(), link_t::MULTIPATH_UNKNOWN);
}

TEST_F(EchoNodeTest, TheEnvironmentNamesTheTerrainOnceItIsKnown) {
  FlatBottom bottom(bench_.lcm(), 100);
  two_at_rest();
  bench_.run_to(3);
  ASSERT_GE(bench_.environments.size(), 2u);
  EXPECT_EQ(bench_.environments.front().terrain_version, "");
  EXPECT_EQ(bench_.environments.back().terrain_version, "flat-1");
}

TEST_F(EchoNodeTest, AnotherTerrainIsQueriedAnew) {
  FlatBottom bottom(bench_.lcm(), 100);
  two_at_rest();
  bench_.run_to(4);
  const auto before = bottom.queries().size();
  bottom.set_terrain("flat-2");
  publish_query(5, {{at(9000, 50), at(9500, 50)}});  // needs other tiles, whose answer names the terrain
  bench_.run_to(10);
  EXPECT_GT(bottom.queries().size(), before + 1);
  EXPECT_EQ(bench_.environments.back().terrain_version, "flat-2");
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, AQueryBetweenPositionsWaitsForTheTerrain) {
  FlatBottom bottom(bench_.lcm(), 100);
  publish_query(5, {{at(0, 50), at(500, 50)}});
  bench_.step(0, /*known=*/false);
  ASSERT_EQ(bench_.replies.size(), 1u);
  EXPECT_EQ(bench_.replies[0].message.answers.at(0).link.multipath, link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, AQueryBetweenPositionsIsUnknownAtTheDeadlineAlsoWithoutSimulationTime) {
  publish_query(5, {{at(0, 50), at(500, 50)}});
  bench_.step(SimTime(), at_s(1), /*known=*/false);
  EXPECT_TRUE(bench_.replies.empty());
  bench_.step(SimTime(), at_s(1.2), false);
  EXPECT_TRUE(bench_.replies.empty());
  bench_.step(SimTime(), at_s(1.25), false);
  ASSERT_EQ(bench_.replies.size(), 1u);
  EXPECT_EQ(bench_.replies[0].message.answers.at(0).answer_status, link_answer_t::ANSWERED);
  EXPECT_EQ(bench_.replies[0].message.answers.at(0).getml_multipath, link_t::MULTIPATH_UNKNOWN);
}

TEST_F(EchoNodeTest, WhileTheServiceIsAwayQueriesAreAnsweredAtOnceUntilItIsBack) {
  FlatBottom bottom(bench_.lcm(), 100);
  bottom.set_away(true);
  publish_query(1, {{at(0, 50), at(500, 50)}});
  bench_.step(SimTime(), at_s(1), false);
  bench_.step(SimTime(), at_s(1.25), false);
  publish_query(2, {{at(0, 50), at(500, 50)}});
  bench_.step(SimTime(), at_s(2), false);  // at once
  ASSERT_EQ(bench_.replies.size(), 2u);
  bottom.set_away(false);
  // A second later failed tiles are asked for again; the first of these queries finds the service back.
  std::int64_t request_id = 3;
  for (const double steady_s : {3.05, 3.1, 3.2}) {
    publish_query(request_id++, {{at(0, 50), at(500, 50)}});
    bench_.step(SimTime(), at_s(steady_s), false);
  }
  ASSERT_EQ(bench_.replies.size(), 5u);
  EXPECT_EQ(bench_.replies[4].message.answers.at(0).link.multipath, link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, AQueryOfVehiclesKnownToTheTablesNeedsNoTerrain) {
  FlatBottom bottom(bench_.lcm(), 100);
  two_at_rest();
  bench_.run_to(2.5);
  const auto before = bottom.queries().size();
  link_end_t one{}, two{};
  one.vehicle_name = "v1";
  two.vehicle_name = "v2";
  publish_query(1, {{one, two}, {two, one}});
  bench_.run_to(2.5);
  EXPECT_EQ(bench_.replies.at(0).message.answers.at(1).link.multipath, link_t::MULTIPATH_LIKELY);
  EXPECT_EQ(bottom.queries().size(), before);
}

}  // namespace
}  // namespace halocline::channel_server
