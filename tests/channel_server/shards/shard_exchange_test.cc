// SPDX-License-Identifier: BSD-3-Clause
// Servers that share the vehicles search for the paths between them once, and what is told changes no result.
#include "channel_server/shards/shard_exchange.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "acoustics/rays/eigenray.h"
#include "bus/bus.h"
#include "bus/messages/channels.h"
#include "bus/messages/message_codec.h"
#include "bus/transport/event_log.h"
#include "bus/transport/node_identity.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/channel_server_node.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/shards/path_messages.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/water_model.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/flat_bottom.h"
#include "tests/channel_server/water_models.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;
using ::testing::AllOf;
using testing::at_s;
using ::testing::Each;
using testing::FlatBottom;
using testing::for_s;
using ::testing::Ge;
using ::testing::Le;
using testing::name_of;

constexpr VehicleId kVehicles = 8;

double slope_z_m(double north_m, double east_m) { return 120 + 0.02 * north_m - 0.01 * east_m; }

// One server of `count`, on a bus of its own with a bathymetry service; what it tells the others is kept.
class Server {
 public:
  Server(Shard shard, ServerRules rules)
      : lcm_("memq://"), bottom_(lcm_, slope_z_m), bus_(lcm_, {"test", 1}), rules_(std::move(rules)) {
    rules_.medium.shard = shard;
    WaterModel water = ray_model(testing::even_water(), {}, {});
    rays_ = static_cast<RayPropagation*>(water.propagation.get());
    node_ = std::make_unique<ChannelServerNode>(
        lcm_, bus::NodeIdentity{"channel-server-" + std::to_string(shard.index), 10 + shard.index},
        std::move(water), ConfiguredModems{testing::quick_modem(), {}}, rules_);
    bus_.subscribe<link_table_t>(channels::kLinks, [this](std::string_view, const link_table_t& m) {
      tables.push_back(m);
      table_steady_s.push_back(steady_.seconds());
    });
    for (int i = 0; i < shard.count; ++i) {
      const std::string channel = channels::kFoundPaths.of("shard-" + std::to_string(i));
      if (i != shard.index) {
        bus_.subscribe<found_paths_t>(
            channel, [this, channel](const found_paths_t& m) { told.emplace_back(channel, m); });
      }
    }
  }

  void state(VehicleId id, double time_s) {
    vehicle_state_t message{};
    message.utime = at_s(time_s).to_utime();
    message.vehicle_id = id;
    message.orientation_wxyz[0] = 1;
    message.position_ned_m[0] = 300.0 * id + 1.5 * time_s;
    message.position_ned_m[1] = 170.0 * (id % 3);
    message.position_ned_m[2] = 20 + 5 * id;
    message.velocity_ned_mps[0] = 1.5;
    bus_.publish(channels::kState.of(name_of(id)), message);
  }
  void publish(const std::string& channel, const found_paths_t& message) { bus_.publish(channel, message); }
  void step(SimTime sim, SimTime steady) {
    steady_ = steady;
    drain();
    for (int turn = 0; turn < 1000; ++turn) {
      const bus::Due due = node_->due();
      if (due.sim > sim && due.steady > steady) return;
      node_->step({sim, steady});
      drain();
    }
    ADD_FAILURE() << "the node keeps itself busy";
  }
  std::int64_t searches() const { return rays_->searches(); }
  std::int64_t refused() const { return node_->counters().refused; }

  std::vector<link_table_t> tables;
  std::vector<double> table_steady_s;
  std::vector<std::pair<std::string, found_paths_t>> told;

 private:
  void drain() {
    while (lcm_.handleTimeout(0) > 0) continue;
  }

  lcm::LCM lcm_;
  FlatBottom bottom_;
  bus::Bus bus_;
  ServerRules rules_;
  RayPropagation* rays_ = nullptr;
  std::unique_ptr<ChannelServerNode> node_;
  SimTime steady_;
};

using Passed = std::function<bool(found_paths_t&)>;  // false: the message is lost

struct Servers {
  explicit Servers(int count) {
    for (int i = 0; i < count; ++i) all.push_back(std::make_unique<Server>(Shard{i, count}, ServerRules{}));
  }
  // Seconds with a tick each; what they tell is passed on between their steps.
  void run(
      int seconds, const Passed& passes = [](found_paths_t&) { return true; }) {
    for (int tenth = 0; tenth < 10 * seconds; ++tenth) {
      const double t = tenth / 10.0;
      for (const auto& server : all) {
        for (VehicleId id = 1; id <= kVehicles; ++id) server->state(id, t);
      }
      for (int pass = 0; pass < 4; ++pass) {
        for (const auto& server : all) server->step(at_s(t), at_s(t));
        for (const auto& server : all) pass_on(*server, passes);
      }
    }
  }
  void pass_on(Server& from, const Passed& passes) {
    for (auto& [channel, message] : std::exchange(from.told, {})) {
      for (const auto& server : all) {
        if (server.get() != &from && passes(message)) server->publish(channel, message);
      }
    }
  }
  std::int64_t searches() const {
    std::int64_t sum = 0;
    for (const auto& server : all) sum += server->searches();
    return sum;
  }
  // Bytes of all tables without what differs between servers, sorted.
  std::vector<bus::Bytes> tables() const {
    std::vector<bus::Bytes> bytes;
    for (const auto& server : all) {
      for (link_table_t table : server->tables) {
        table.session = table.sequence = 0;
        bytes.push_back(bus::encoded(table));
      }
    }
    std::sort(bytes.begin(), bytes.end());
    return bytes;
  }

  std::vector<std::unique_ptr<Server>> all;
};

class ShardExchangeTest : public ::testing::Test {
 protected:
  ShardExchangeTest() { bus::set_log_level(bus::LogLevel::kSilent); }
};

TEST(ShardOwner, EachPairOfTwoServersHasOneOfTheTwoAsItsOwner) {
  for (const int count : {2, 3, 7}) {
    for (VehicleId a = 1; a <= 40; ++a) {
      for (VehicleId b = 1; b <= 40; ++b) {
        const int owner = Shard{0, count}.owner_of(a, b);
        EXPECT_TRUE(owner == a % count || owner == b % count);
        for (int index = 0; index < count; ++index) EXPECT_EQ((Shard{index, count}.owner_of(b, a)), owner);
      }
    }
  }
}

TEST(ShardOwner, EachServerOwnsAboutAsManyPairs) {
  for (const int count : {2, 3, 4}) {
    std::vector<int> owned(static_cast<std::size_t>(count));
    int pairs = 0;
    for (VehicleId a = 1; a <= 120; ++a) {
      for (VehicleId b = a + 1; b <= 120; ++b, ++pairs)
        ++owned[static_cast<std::size_t>(Shard{0, count}.owner_of(a, b))];
    }
    EXPECT_THAT(owned, Each(AllOf(Ge(0.95 * pairs / count), Le(1.05 * pairs / count))));
  }
}

acoustics::Eigenray some_path(double delay_s) {
  acoustics::Eigenray path;
  path.delay_s = delay_s;
  path.amplitude = 1.0 / 3;
  path.phase_rad = 2.0 / 3;
  path.launch_angle_rad = -0.1;
  path.arrival_angle_rad = 0.7 / 3;
  path.launch_slowness_spm = 1 / 1500.3;
  path.range_slowness_spm = -1 / 1500.7;
  path.path_length_m = 1500 * delay_s;
  path.absorption_db = 0.1;
  path.surface_loss_db = 1.1;
  path.bottom_loss_db = 2.3;
  path.surface_sine_squares = 0.01;
  path.bottom_sine_squares = 0.02;
  path.surface_bounces = 1;
  path.bottom_bounces = 2;
  path.caustics = 3;
  path.diffuse = true;
  path.identity = {true, 4, 5, 6, 7, 8};
  return path;
}

TEST(PathMessages, PathsComeBackToTheLastBit) {
  PathQuery query;
  query.frequency_hz = 25'000.1;
  query.places = {1.1, -2.2, 3.3, 1e3 / 7};
  query.link = {10.1, 20.2, 1000.3};
  query.diffuse_below_pressure = 1e-7 / 3;
  SearchResult found;
  found.mean_depth_m = 100.0 / 3;
  found.blocked = true;
  found.eigenrays = {
      acoustics::RaySolver::kArcs, {some_path(0.7), some_path(0.9)}, acoustics::PathLack::kTooWeak};
  const auto message = to_message(42, query, found);
  ASSERT_TRUE(message);
  link_search_t decoded;
  ASSERT_EQ(bus::decode(std::span<const std::uint8_t>(bus::encoded(*message)), decoded), "");
  const PathQuery query_again = to_query(decoded);
  EXPECT_EQ(query_again.key(), query.key());
  const SearchResult again = to_result(decoded);
  EXPECT_EQ(again.mean_depth_m, found.mean_depth_m);
  EXPECT_EQ(again.blocked, found.blocked);
  EXPECT_EQ(again.eigenrays.solver, found.eigenrays.solver);
  EXPECT_EQ(again.eigenrays.lack, found.eigenrays.lack);
  EXPECT_EQ(bus::encoded(*to_message(42, query_again, again)), bus::encoded(*message));
  EXPECT_EQ(again.eigenrays.paths.at(1).identity, found.eigenrays.paths[1].identity);
  EXPECT_EQ(again.eigenrays.paths[1].range_slowness_spm, found.eigenrays.paths[1].range_slowness_spm);
}

TEST(PathMessages, WhatTheMessageCannotHoldIsNotTold) {
  PathQuery query;
  query.frequency_hz = 25'000;
  SearchResult found;
  found.eigenrays.paths.assign(401, some_path(0.7));
  EXPECT_FALSE(to_message(42, query, found));
  found.eigenrays.paths = {some_path(0.7)};
  EXPECT_TRUE(to_message(42, query, found));
  found.eigenrays.paths[0].surface_bounces = 40'000;
  EXPECT_FALSE(to_message(42, query, found));
}

TEST_F(ShardExchangeTest, ServersSearchTogetherAsOftenAsOneAndPublishItsTables) {
  Servers one(1);
  one.run(12);
  ASSERT_EQ(one.tables().size(), 11u * kVehicles);  // nobody is known at 0
  ASSERT_GT(one.searches(), 3 * kVehicles * (kVehicles - 1) / 2);
  for (const int count : {2, 3}) {
    Servers many(count);
    many.run(12);
    EXPECT_EQ(many.tables(), one.tables()) << count;
    EXPECT_EQ(many.searches(), one.searches()) << count;
  }
}

TEST_F(ShardExchangeTest, WhatIsLostIsSearchedForAgain) {
  Servers one(1);
  one.run(12);
  Servers two(2);
  int n = 0;
  two.run(12, [&](found_paths_t& message) {  // every third message loses what it holds, and the mark comes
    if (++n % 3 == 0) {
      message.searches.clear();
      message.num_searches = 0;
    }
    return true;
  });
  EXPECT_EQ(two.tables(), one.tables());
  EXPECT_GT(two.searches(), one.searches());
}

TEST_F(ShardExchangeTest, WhoHearsNothingOfTheOtherWaitsOnceUntilTheDeadline) {
  Servers one(1);
  one.run(6);
  Servers two(2);
  two.run(6, [](found_paths_t&) { return false; });
  EXPECT_EQ(two.tables(), one.tables());
  const auto& steady_s = two.all[0]->table_steady_s;
  EXPECT_GE(steady_s.front(), 1 + RayQueryClient::kAnswerDeadline.seconds());
  for (std::size_t i = kVehicles / 2; i < steady_s.size(); ++i)
    EXPECT_EQ(at_s(steady_s[i]).to_utime(), two.all[0]->tables[i].utime) << i;
}

TEST_F(ShardExchangeTest, PathsOfAnotherSeaAreNotTaken) {
  Servers one(1);
  one.run(6);
  Servers two(2);
  two.run(6, [](found_paths_t& message) {
    for (link_search_t& search : message.searches) {
      ++search.sea_hash;
      for (eigenray_t& path : search.eigenrays) path.amplitude *= 2;
    }
    return true;
  });
  EXPECT_EQ(two.tables(), one.tables());
  EXPECT_EQ(two.all[0]->refused(), 0);
}

TEST_F(ShardExchangeTest, ImpossibleMessagesAreRefusedAndChangeNothing) {
  Servers one(1);
  one.run(4);
  const std::vector<std::pair<const char*, std::function<void(found_paths_t&)>>> faults{
      {"its own", [](found_paths_t& m) { m.shard_index = 1 - m.shard_index; }},
      {"of another count", [](found_paths_t& m) { m.shard_count = 3; }},
      {"beyond the count", [](found_paths_t& m) { m.shard_index = 7; }},
      {"not a number", [](found_paths_t& m) { m.searches.at(0).range_m = std::nan(""); }},
      {"no depth", [](found_paths_t& m) { m.searches.at(0).source_depth_m = -1; }},
      {"no frequency", [](found_paths_t& m) { m.searches.at(0).frequency_hz = 0; }},
      {"no solver", [](found_paths_t& m) { m.searches.at(0).ray_solver = 9; }},
      {"faster than sound", [](found_paths_t& m) { m.searches.at(0).eigenrays.at(0).delay_s = 1e-5; }},
      {"no amplitude", [](found_paths_t& m) { m.searches.at(0).eigenrays.at(0).amplitude = 0; }},
      {"out of order",
       [](found_paths_t& m) {
         eigenray_t& path = m.searches.at(0).eigenrays.at(0);
         path.delay_s *= 2;
         path.path_length_m *= 2;
       }},
  };
  for (const auto& [name, spoil] : faults) {
    Servers two(2);
    int spoilt = 0;
    two.run(4, [&](found_paths_t& message) {
      if (message.num_searches == 0) return true;
      ++spoilt;
      spoil(message);
      return true;
    });
    EXPECT_EQ(two.tables(), one.tables()) << name;
    EXPECT_GE(spoilt, 2) << name;
    EXPECT_EQ(two.all[0]->refused() + two.all[1]->refused(), spoilt) << name;
  }
}

}  // namespace
}  // namespace halocline::channel_server
