// SPDX-License-Identifier: BSD-3-Clause
// LINK_QUERY with wants_paths: paths, their ways and terms, the seabed and the water of one link.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/beam_pattern.h"
#include "bus/messages/message_checks.h"
#include "bus/transport/event_log.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/water_model.h"
#include "core/units.h"
#include "tests/channel_server/link_queries.h"
#include "tests/channel_server/node_bench.h"
#include "tests/channel_server/water_models.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at;
using testing::FlatBottom;
using testing::kSpeedMps;
using testing::named;
using testing::NodeBench;

constexpr int kPacedMessage = 60'000;  // bytes, docs/architecture.md

struct Bench {
  explicit Bench(
      WaterModel water, FlatBottom::DepthAt bottom_z_m = [](double, double) { return 100.0; },
      const VehicleModem& modem = testing::quick_modem())
      : bench({}, {modem, {}}, std::move(water)), bottom(bench.lcm(), std::move(bottom_z_m)) {
    bus::set_log_level(bus::LogLevel::kSilent);
  }
  link_reply_t reply_to(const std::vector<std::pair<link_end_t, link_end_t>>& links,
                        bool wants_paths = true) {
    link_query_t query = testing::link_query(links, ++requests);
    query.wants_paths = wants_paths ? 1 : 0;
    bench.replies.clear();
    bench.bus().publish("LINK_QUERY", query);
    for (int i = 0; i < 10 && bench.replies.empty(); ++i) bench.step(time_s += 0.1);
    EXPECT_EQ(bench.replies.size(), 1u);
    const link_reply_t reply = bench.replies.at(0).message;
    EXPECT_EQ(bus::problem_in(reply), "");
    EXPECT_LT(reply.getEncodedSize(), kPacedMessage);
    return reply;
  }

  NodeBench bench;
  FlatBottom bottom;
  std::int64_t requests = 0;
  double time_s = 1;
};

// Source level less all losses is the level of each path.
void expect_terms_add_up(const link_paths_t& sound) {
  for (const arrival_t& path : sound.paths) {
    const double losses = path.spreading_loss_db + path.absorption_loss_db + path.surface_loss_db +
                          path.bottom_loss_db + path.beam_loss_db;
    EXPECT_NEAR(sound.source_level_db - losses, path.path_level_db, tolerance(1e-9));
    EXPECT_GE(path.surface_loss_db, -1e-9);
    EXPECT_GE(path.bottom_loss_db, -1e-6);
  }
}

// Each path's points from the transmitter to the receiver, in order of the paths.
void expect_ways_between_the_ends(const link_paths_t& sound) {
  std::vector<std::vector<std::pair<float, float>>> ways(sound.paths.size());
  for (std::size_t i = 0; i < sound.point_path.size(); ++i) {
    ways.at(static_cast<std::size_t>(sound.point_path[i]))
        .emplace_back(sound.point_range_m[i], sound.point_depth_m[i]);
  }
  EXPECT_TRUE(std::is_sorted(sound.point_path.begin(), sound.point_path.end()));
  for (const auto& way : ways) {
    ASSERT_GE(way.size(), 2u);
    ASSERT_LE(way.size(), 64u);
    EXPECT_EQ(way.front().first, 0);
    EXPECT_NEAR(way.front().second, sound.source_depth_m, 1e-4);
    EXPECT_NEAR(way.back().first, sound.link_range_m, 1e-3);
    EXPECT_NEAR(way.back().second, sound.receiver_depth_m, 1e-4);
  }
}

WaterModel rays() { return ray_model(testing::even_water(), {}, {}); }

TEST(LinkPaths, OfTheStraightModelAreTheStraightLine) {
  VehicleModem modem = testing::quick_modem();
  modem.modem.beam = acoustics::BeamPattern({{-1.5, 6}, {1.5, 6}});
  Bench bench(
      straight_model(testing::even_water()), [](double, double) { return 100.0; }, modem);
  const link_reply_t reply = bench.reply_to({{at(0, 50), at(1500, 90)}});
  const link_paths_t& sound = reply.link_paths;
  const link_t& link = reply.answers.at(0).link;
  ASSERT_EQ(sound.num_paths, 1);
  EXPECT_EQ(sound.paths[0].path_delay_s, link.delay_s);
  EXPECT_NEAR(sound.paths[0].path_level_db, link.received_level_db, tolerance(1e-9));
  EXPECT_EQ(sound.paths[0].beam_loss_db, 12);
  EXPECT_NEAR(sound.paths[0].spreading_loss_db, 15 * std::log10(link.range_m), tolerance(1e-9));
  EXPECT_EQ(sound.paths[0].guard_weight, 1);
  EXPECT_EQ(sound.point_range_m, (std::vector<float>{0, 1500}));
  EXPECT_EQ(sound.point_depth_m, (std::vector<float>{50, 90}));
  EXPECT_EQ(sound.num_seabed, 0);
  EXPECT_EQ(sound.water_depth_m.front(), 0);
  EXPECT_EQ(sound.water_depth_m.back(), 90);
  for (const float speed : sound.water_sound_speed_mps) EXPECT_NEAR(speed, kSpeedMps, 1e-3);
  expect_terms_add_up(sound);
}

TEST(LinkPaths, OfRaysAreThoseOfTheAnswer) {
  Bench bench(rays());
  const link_reply_t reply = bench.reply_to({{at(0, 50), at(1000, 60)}});
  const link_paths_t& sound = reply.link_paths;
  const link_t& link = reply.answers.at(0).link;
  EXPECT_EQ(link.propagation_used, link_t::USED_RAYS);
  EXPECT_EQ(sound.num_paths + sound.paths_left_out, link.num_paths);
  EXPECT_GT(sound.num_paths, 5);
  EXPECT_EQ(sound.source_level_db, testing::quick_modem().modem.source_level.value);
  EXPECT_EQ(sound.link_range_m, 1000);
  EXPECT_EQ(sound.source_depth_m, 50);
  EXPECT_EQ(sound.receiver_depth_m, 60);
  // The direct path: 10 m down over 1000 m; bounce paths are later.
  EXPECT_NEAR(sound.paths[0].path_delay_s, std::hypot(1000, 10) / kSpeedMps, tolerance(1e-9));
  EXPECT_NEAR(sound.paths[0].launch_angle_rad, std::atan2(10, 1000), tolerance(1e-6));
  double greatest_weight = 0;
  double last_delay_s = 0;
  for (const arrival_t& path : sound.paths) {
    EXPECT_GE(path.path_delay_s, std::exchange(last_delay_s, path.path_delay_s));
    greatest_weight = std::max(greatest_weight, path.guard_weight);
  }
  EXPECT_EQ(greatest_weight, 1);
  ASSERT_GE(sound.num_seabed, 2);
  for (const float depth : sound.seabed_depth_m) EXPECT_NEAR(depth, 100, 1e-3);
  EXPECT_EQ(sound.seabed_range_m.front(), 0);
  EXPECT_EQ(sound.seabed_range_m.back(), 1000);
  expect_terms_add_up(sound);
  expect_ways_between_the_ends(sound);
}

TEST(LinkPaths, OfTheWayBackAreMirrored) {
  Bench bench(rays(), [](double north, double) { return 100 + 0.02 * north; });
  bench.bench.state(1, 0, {0, 0, 50});
  bench.bench.state(2, 0, {1000, 0, 70});
  const link_paths_t there = bench.reply_to({{named("v1"), named("v2")}}).link_paths;
  const link_paths_t back = bench.reply_to({{named("v2"), named("v1")}}).link_paths;
  ASSERT_GT(there.num_paths, 3);
  ASSERT_EQ(there.num_paths, back.num_paths);
  EXPECT_EQ(back.source_depth_m, 70);
  EXPECT_EQ(back.receiver_depth_m, 50);
  for (std::size_t i = 0; i < there.paths.size(); ++i) {
    EXPECT_EQ(back.paths[i].path_delay_s, there.paths[i].path_delay_s);
    EXPECT_EQ(back.paths[i].launch_angle_rad, -there.paths[i].arrival_angle_rad);
    EXPECT_EQ(back.paths[i].guard_weight, there.paths[i].guard_weight);
  }
  EXPECT_NEAR(there.seabed_depth_m.front(), 100, 0.01);
  EXPECT_NEAR(there.seabed_depth_m.back(), 120, 0.01);
  EXPECT_NEAR(back.seabed_depth_m.front(), 120, 0.01);
  expect_ways_between_the_ends(there);
  expect_ways_between_the_ends(back);
  expect_terms_add_up(back);
}

TEST(LinkPaths, ManyPathsKeepTheStrongestBelowAPacedMessage) {
  RayModel hard;
  hard.bottom = {.density_ratio = 2.7, .sound_speed_ratio = 3.5, .loss_parameter = 0.001};
  hard.options.max_bounces = 200;
  hard.options.min_boundary_factor = 1e-4;
  hard.options.diffuse_below_db = 0;  // every path
  VehicleModem loud = testing::quick_modem();
  loud.modem.centre_frequency_hz = 2000;
  loud.modem.bandwidth_hz = 500;
  Bench bench(
      ray_model(testing::even_water(), hard, {}),
      [](double north, double) { return 40 + 3 * std::sin(north / 90); }, loud);
  const link_reply_t reply = bench.reply_to({{at(0, 20), at(2500, 30)}});
  EXPECT_EQ(reply.link_paths.num_paths, 64);
  EXPECT_GT(reply.link_paths.paths_left_out, 20);
  EXPECT_EQ(reply.link_paths.num_paths + reply.link_paths.paths_left_out, reply.answers.at(0).link.num_paths);
  expect_ways_between_the_ends(reply.link_paths);
  expect_terms_add_up(reply.link_paths);
}

TEST(LinkPaths, WithoutTheBathymetryServiceArePathsOfTheStraightModel) {
  Bench bench(rays());
  bench.bottom.set_away(true);
  const link_reply_t reply = bench.reply_to({{at(0, 50), at(1000, 60)}});
  EXPECT_EQ(reply.answers.at(0).link.propagation_used, link_t::USED_STRAIGHT_WITHOUT_BOTTOM);
  EXPECT_EQ(reply.link_paths.num_paths, 1);
  EXPECT_EQ(reply.link_paths.num_points, 2);
  EXPECT_EQ(reply.link_paths.num_seabed, 0);
}

TEST(LinkPaths, AreEmptyUnlessTheyAreWantedAndTheLinkIsAnswered) {
  Bench bench(rays());
  for (const auto& [to, wanted] :
       {std::pair(at(1000, 60), false), {at(1000, 150), true}, {named("nobody"), true}}) {
    const link_paths_t sound = bench.reply_to({{at(0, 50), to}}, wanted).link_paths;
    EXPECT_EQ(sound.num_paths, 0);
    EXPECT_EQ(sound.num_water, 0);
    EXPECT_EQ(sound.source_level_db, 0);
  }
}

TEST(LinkPaths, OfSeveralLinksAreRefusedWithTheLimit) {
  Bench bench(rays());
  const link_reply_t reply = bench.reply_to({{at(0, 50), at(1, 50)}, {at(0, 50), at(2, 50)}});
  EXPECT_EQ(reply.reply_status, link_reply_t::REFUSED);
  EXPECT_EQ(reply.refusal, "num_links is 2; allowed is 1 with wants_paths");
  EXPECT_EQ(bench.reply_to({}).refusal, "num_links is 0; allowed is 1 with wants_paths");
}

}  // namespace
}  // namespace halocline::channel_server
