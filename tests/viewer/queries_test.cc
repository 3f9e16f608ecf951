// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "core/sim_time.h"
#include "tests/viewer/run_for_pages.h"
#include "viewer/pages/binary_messages.h"
#include "viewer/pages/command_desk.h"
#include "viewer/pages/link_view.h"
#include "viewer/pages/packet_json.h"
#include "viewer/pages/query_desk.h"
#include "viewer/pages/terrain_window.h"
#include "viewer/sources/handover.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

struct Posted {
  std::vector<std::pair<std::string, bus::Bytes>> messages;
  auto post() {
    return [this](const std::string& channel, bus::Bytes bytes) {
      messages.emplace_back(channel, std::move(bytes));
    };
  }
};

link_reply_t reply_to(const link_query_t& query) {
  link_reply_t reply{};
  reply.request_id = query.request_id;
  reply.num_answers = 1;
  reply.answers.resize(1);
  reply.answers[0].link.received_level_db = 103;
  reply.answers[0].link.noise_level_db = 91;
  reply.answers[0].link.snr_db = 12;
  reply.answers[0].link.sinr_db = 10;
  // SINR = 1 / (noise + late echoes)
  reply.answers[0].link.noise_db = -12;
  reply.answers[0].link.late_echo_db = 10 * std::log10(0.1 - std::pow(10, -1.2));
  reply.answers[0].link.fast_fading_db = reply.answers[0].link.interference_db = -300;
  reply.answers[0].link.impulse_db = -300;
  reply.link_paths.source_level_db = 165;
  arrival_t path{};
  path.path_level_db = 101;
  path.path_delay_s = 1;
  path.spreading_loss_db = 60;
  path.absorption_loss_db = 4;
  reply.link_paths.num_paths = 1;
  reply.link_paths.paths = {path};
  reply.link_paths.num_points = 2;
  reply.link_paths.point_path = {0, 0};
  reply.link_paths.point_range_m = {0, 1500};
  reply.link_paths.point_depth_m = {20, 50};
  return reply;
}

TEST(QueryDesk, ReplyIsMatchedOnceByItsNumber) {
  Posted posted;
  QueryDesk desk("monitor-1", posted.post());
  int done = 0;
  desk.ask(link_query_t{},
           [&](const link_reply_t* reply, const std::string&) { done += reply != nullptr ? 1 : 100; });
  ASSERT_EQ(posted.messages.size(), 1u);
  EXPECT_EQ(posted.messages[0].first, "LINK_QUERY");
  link_query_t query{};
  ASSERT_EQ(
      query.decode(posted.messages[0].second.data(), 0, static_cast<int>(posted.messages[0].second.size())),
      static_cast<int>(posted.messages[0].second.size()));
  EXPECT_EQ(query.client_name, "monitor-1");
  EXPECT_TRUE(desk.is_reply("LINK_REPLY.monitor-1"));
  EXPECT_FALSE(desk.is_reply("LINK_REPLY.monitor-2"));
  const BusMessage message{0, "LINK_REPLY.monitor-1", bus::encoded(reply_to(query))};
  desk.take({0, "LINK_REPLY.monitor-1", {1, 2, 3}});
  desk.take(message);
  desk.take(message);
  EXPECT_EQ(done, 1);
}

TEST(QueryDesk, RepeatsAndGivesUp) {
  Posted posted;
  QueryDesk desk("monitor-1", posted.post());
  std::string problem;
  desk.tick(0);
  desk.ask(terrain_query_t{}, [&](const terrain_tile_t*, const std::string& text) { problem = text; });
  desk.tick(0.5);
  EXPECT_EQ(posted.messages.size(), 1u);
  desk.tick(1.1);
  EXPECT_EQ(posted.messages.size(), 2u);
  desk.tick(QueryDesk::kPatience_s + 0.1);
  EXPECT_THAT(problem, HasSubstr("bathymetry service does not answer"));
}

TEST(QueryDesk, TooManyAtOnceAreRefused) {
  Posted posted;
  QueryDesk desk("monitor-1", posted.post());
  std::string problem;
  for (std::size_t i = 0; i <= QueryDesk::kMaxUnderWay; ++i)
    desk.ask(link_query_t{}, [&](const link_reply_t*, const std::string& text) { problem = text; });
  EXPECT_THAT(problem, HasSubstr("Too many"));
}

TEST(TerrainWindow, IsCollectedFromSeveralTiles) {
  Posted posted;
  QueryDesk desk("m", posted.post());
  std::optional<DepthGrid> grid;
  const DepthGrid window = terrain_window_in(
      json::parse(R"({"south_m":-100,"west_m":-50,"spacing_m":10,"rows":100,"columns":257})"));
  collect_terrain(desk, window, [&](const DepthGrid* whole, const std::string&) { grid = *whole; });
  ASSERT_EQ(posted.messages.size(), 3u);
  for (const auto& [channel, bytes] : posted.messages) {
    const auto query = bus::decoded<terrain_query_t>(bytes);
    ASSERT_TRUE(query);
    terrain_tile_t tile{};
    tile.request_id = query->request_id;
    tile.post_spacing_m = 10;
    tile.tile_rows = query->requested_rows;
    tile.tile_columns = query->requested_columns;
    tile.num_posts = tile.tile_rows * tile.tile_columns;
    tile.seabed_z_m.assign(static_cast<std::size_t>(tile.num_posts),
                           static_cast<float>(query->corner_north_m));
    tile.post_known.assign(static_cast<std::size_t>(tile.num_posts), 1);
    tile.post_known[0] = 0;
    desk.take({0, "TERRAIN_REPLY.m", bus::encoded(tile)});
  }
  ASSERT_TRUE(grid);
  EXPECT_TRUE(std::isnan(grid->depth_m[0]));
  EXPECT_EQ(grid->depth_m[1], -100.0F);
  EXPECT_EQ(grid->depth_m.back(), static_cast<float>(-100 + 10 * 76));
  EXPECT_THROW(
      terrain_window_in(json::parse(R"({"south_m":0,"west_m":0,"spacing_m":10,"rows":1000,"columns":2})")),
      InvalidArgument);
}

TEST(TerrainWindow, OverviewIsOfTheWholeExtent) {
  Posted posted;
  QueryDesk desk("m", posted.post());
  int done = 0;
  collect_overview(desk, [&](const terrain_tile_t& overview) { done += overview.tile_rows; });
  terrain_tile_t tile{};
  tile.request_id = 1;
  tile.extent_south_m = -4000;
  tile.extent_west_m = -2000;
  tile.extent_north_m = 5600;
  tile.extent_east_m = 2800;
  tile.finest_spacing_m = 50;
  desk.take({0, "TERRAIN_REPLY.m", bus::encoded(tile)});
  ASSERT_EQ(posted.messages.size(), 2u);
  const auto query = bus::decoded<terrain_query_t>(posted.messages[1].second);
  ASSERT_TRUE(query);
  EXPECT_EQ(query->corner_north_m, -4000);
  EXPECT_EQ(query->post_spacing_m, 100);
  EXPECT_EQ(query->requested_rows, 97);
  EXPECT_EQ(query->requested_columns, 49);
  tile.request_id = 2;
  tile.tile_rows = 1;
  tile.tile_columns = 1;
  tile.num_posts = 1;
  tile.seabed_z_m = {120};
  tile.post_known = {1};
  desk.take({0, "TERRAIN_REPLY.m", bus::encoded(tile)});
  EXPECT_EQ(done, 1);
}

TEST(LinkView, QueriesWhereBothWere) {
  const auto timeline = testing::small_run();
  auto query = link_query({timeline.vehicles()[0], timeline.vehicles()[1], SimTime::from_seconds(30)});
  ASSERT_TRUE(query);
  EXPECT_EQ(query->transmitters[0].vehicle_name, "auv-1");
  EXPECT_EQ(query->transmitters[0].position_ned_m[0], 30);
  EXPECT_TRUE(query->wants_paths);
  use_positions(timeline, *query);
  EXPECT_EQ(query->transmitters[0].vehicle_name, "");
  EXPECT_FALSE(link_query({timeline.vehicles()[0], timeline.vehicles()[1], SimTime::from_seconds(-1)}));
}

TEST(LinkView, BudgetAddsUpToWhatWasComputed) {
  const auto timeline = testing::small_run();
  PacketIndex packets;
  const LinkSubject link{timeline.vehicles()[0], timeline.vehicles()[1], SimTime::from_seconds(60)};
  const link_reply_t reply = reply_to({});
  const json view = link_view_json(timeline, packets, link, &reply, "");
  double sum = 0;
  for (const json& row : view["budget"]) {
    if (row["kind"] == "start") sum = row["value"];
    if (row["kind"] == "step") sum += row["value"].get<double>();
    if (row["kind"] == "total") {
      EXPECT_NEAR(row["value"].get<double>(), sum, 1e-9) << row["label"];
    }
  }
  EXPECT_NEAR(sum, 10, 1e-9);
  EXPECT_EQ(view["paths"][0]["level_db"], -64);
  EXPECT_EQ(view["paths"][0]["range_m"], json({0, 1500}));
  EXPECT_TRUE(view["seabed"].is_null());
  EXPECT_EQ(view["fading"]["packets"].size(), 2u);
  EXPECT_EQ(view["fading"]["expected"]["value"], json({11}));
}

TEST(LinkView, WithoutReplySaysWhy) {
  const auto timeline = testing::small_run();
  PacketIndex packets;
  const LinkSubject link{timeline.vehicles()[0], timeline.vehicles()[1], SimTime::from_seconds(60)};
  const json view = link_view_json(timeline, packets, link, nullptr, "The channel server does not answer.");
  EXPECT_EQ(view["notice"], "The channel server does not answer.");
  EXPECT_EQ(view["range_m"], std::hypot(60, 1500));
}

TEST(CommandDesk, RepeatsACommandForItsTime) {
  Posted posted;
  const auto timeline = testing::small_run();
  CommandDesk desk(77, posted.post());
  desk.tick(0, timeline, timeline.end());
  desk.command(
      timeline,
      json::parse(R"({"vehicle":0,"propeller_rpm":1000,"rudder_rad":0.1,"stern_plane_rad":0,"for_s":0.25})"));
  for (const double now_s : {0.05, 0.1, 0.16, 0.27, 0.4, 0.5}) desk.tick(now_s, timeline, timeline.end());
  ASSERT_EQ(posted.messages.size(), 3u);
  const auto command = bus::decoded<vehicle_command_t>(posted.messages[2].second);
  ASSERT_TRUE(command);
  EXPECT_EQ(posted.messages[2].first, "COMMAND.auv-1");
  EXPECT_EQ(command->propeller_rpm, 1000);
  EXPECT_EQ(command->sequence, 2);
}

TEST(CommandDesk, RefusesWhatTheBusWould) {
  Posted posted;
  const auto timeline = testing::small_run();
  CommandDesk desk(77, posted.post());
  const auto command = [&](const char* text) { desk.command(timeline, json::parse(text)); };
  EXPECT_THROW(command(R"({"vehicle":0,"propeller_rpm":1e9,"rudder_rad":0,"stern_plane_rad":0,"for_s":1})"),
               InvalidArgument);
  EXPECT_THROW(command(R"({"vehicle":0,"propeller_rpm":1,"rudder_rad":9,"stern_plane_rad":0,"for_s":1})"),
               InvalidArgument);
  EXPECT_THROW(command(R"({"vehicle":5,"propeller_rpm":1,"rudder_rad":0,"stern_plane_rad":0,"for_s":1})"),
               InvalidArgument);
  EXPECT_THROW(command(R"({"vehicle":0,"propeller_rpm":1,"rudder_rad":0,"stern_plane_rad":0,"for_s":1000})"),
               InvalidArgument);
  const auto send = [&](const char* text) { desk.send(timeline, json::parse(text), timeline.end(), {}); };
  EXPECT_THROW(send(R"({"vehicle":0,"destination":0,"payload":"x"})"), InvalidArgument);
  EXPECT_THROW(send(R"({"vehicle":0,"destination":1})"), InvalidArgument);
  EXPECT_TRUE(posted.messages.empty());
}

TEST(CommandDesk, SendIsAnsweredWithThePacketsKey) {
  Posted posted;
  auto timeline = testing::small_run();
  CommandDesk desk(77, posted.post());
  std::string key;
  desk.send(timeline, json::parse(R"({"vehicle":0,"destination":1,"payload":"hi"})"), timeline.end(),
            [&](const std::string& k) { key = k; });
  desk.tick(0.05, timeline, timeline.end());
  EXPECT_EQ(key, "");
  timeline.add(0, posted.messages[0].first, posted.messages[0].second);
  desk.tick(0.1, timeline, timeline.end());
  EXPECT_EQ(key, "p3");
}

}  // namespace
}  // namespace halocline::monitor
