// SPDX-License-Identifier: BSD-3-Clause
// The channel server and the bathymetry service: echoes in tables and answers, and the service away and back.
#include <cstdint>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/transport/event_log.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/seabed_client.h"
#include "channel_server/vehicles/vehicle_id.h"
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
  std::int64_t last_request_in(const FlatBottom& bottom) { return bottom.queries().back().request_id; }
  void publish_query(std::int64_t request_id, const std::vector<std::pair<link_end_t, link_end_t>>& ends) {
    bench_.bus().publish("LINK_QUERY", testing::link_query(ends, request_id));
  }

  NodeBench bench_;
};

TEST_F(EchoNodeTest, ARowHoldsTheEchoesOfTheTickBefore) {
  FlatBottom bottom(bench_.lcm(), 100);
  two_at_rest();
  bench_.run_to(1);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_UNKNOWN);
  bench_.run_to(2);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, AVehicleAtRestIsQueriedOnce) {
  FlatBottom bottom(bench_.lcm(), 100);
  two_at_rest();
  bench_.run_to(14);
  EXPECT_EQ(bottom.queries().size(), 2u);  // depths, ways
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
  bench_.run_to(7);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, TheServiceLostAfterwardsMakesRowsOfMovedVehiclesUnknown) {
  FlatBottom bottom(bench_.lcm(), 100);
  for (double t = 0; t <= 10; t += 0.5) {
    bench_.state(1, t, {0, 0, 50});
    bench_.state(2, t, {500 + 4 * t, 0, 50}, {4, 0, 0});
  }
  bench_.run_to(3);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
  bottom.set_away(true);
  bench_.run_to(10);
  EXPECT_EQ(multipath(), link_t::MULTIPATH_UNKNOWN);
}

TEST_F(EchoNodeTest, ARecordedReplyIsNotTakenForTheServices) {
  two_at_rest();
  ray_reply_t recorded{};
  recorded.request_id = 1;
  recorded.num_rays = 9;
  recorded.ray_status.assign(9, ray_reply_t::HIT);
  recorded.result_m.assign(9, 60);
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
  for (double t = 0; t <= 10; t += 0.5) {
    bench_.state(1, t, {0, 0, 50});
    bench_.state(2, t, {500, 0, 50});
    bench_.state(3, t, {4 * t, 300, 50}, {4, 0, 0});  // keeps the conversation going
  }
  bench_.run_to(4);
  const auto before = bottom.queries().size();
  bottom.set_terrain("flat-2");
  bench_.run_to(10);
  EXPECT_GT(bottom.queries().size(), before + 4);
  EXPECT_EQ(bench_.environments.back().terrain_version, "flat-2");
  EXPECT_EQ(multipath(), link_t::MULTIPATH_LIKELY);
}

TEST_F(EchoNodeTest, ALargeFleetIsQueriedWithinItsAllowance) {
  ServerRules rules;
  rules.echoes.surveys_per_table = 100;
  NodeBench bench(rules);
  FlatBottom bottom(bench.lcm(), 100);
  for (double t = 0; t <= 3; t += 0.5) {
    for (VehicleId id = 1; id <= 60; ++id) bench.state(id, t, {10.0 * id, 0, 50});
  }
  bench.run_to(1);
  std::int64_t rays = 0;
  for (const auto& query : bottom.queries()) {
    EXPECT_LE(query.num_rays, 1024);
    rays += query.num_rays;
  }
  EXPECT_EQ(rays, 100 * 3 * 9);  // a depth and two ways for each of nine points
  bench.run_to(3);
  EXPECT_THAT(bench.statuses.back().message.status_text, HasSubstr("1470 echo surveys put off"));
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
  bench_.step(SimTime(), at_s(2), false);  // at once; its probe goes out
  ASSERT_EQ(bench_.replies.size(), 2u);
  bottom.set_away(false);
  publish_query(3, {{at(0, 50), at(500, 50)}});
  bench_.step(SimTime(), at_s(2.15), false);  // the probe is repeated and answered
  publish_query(4, {{at(0, 50), at(500, 50)}});
  bench_.step(SimTime(), at_s(2.2), false);
  ASSERT_EQ(bench_.replies.size(), 4u);
  EXPECT_EQ(bench_.replies[3].message.answers.at(0).link.multipath, link_t::MULTIPATH_LIKELY);
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
