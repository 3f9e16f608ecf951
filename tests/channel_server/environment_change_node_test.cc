// SPDX-License-Identifier: BSD-3-Clause
// The water changes during a run: what moves, from which instant, and what stays.
#include <cstdint>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "acoustics/sea/boundary_reflection.h"
#include "bus/transport/event_log.h"
#include "tests/channel_server/link_queries.h"
#include "tests/channel_server/node_bench.h"
#include "tests/channel_server/water_models.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::FlatBottom;
using testing::NodeBench;

class EnvironmentChangeNodeTest : public ::testing::Test {
 protected:
  EnvironmentChangeNodeTest() { bus::set_log_level(bus::LogLevel::kSilent); }
  void two_at_rest(double end_s = 20) {
    for (double t = 0; t <= end_s; t += 0.5) {
      bench_.state(1, t, {0, 0, 50});
      bench_.state(2, t, {500, 0, 50});
    }
  }
  // The row from 1 to 2 of the table of an instant.
  link_t row_at(double time_s) {
    for (const auto& table : bench_.links) {
      if (table.message.vehicle_id == 1 && table.message.utime == at_s(time_s).to_utime()) {
        return table.message.peers.at(0);
      }
    }
    throw std::runtime_error("no table at " + std::to_string(time_s));
  }
  NodeBench bench_;
};

TEST_F(EnvironmentChangeNodeTest, AnnouncedWindMovesNoiseFromItsInstantAndNothingElse) {
  two_at_rest();
  bench_.run_to(2);
  bench_.change(bench_.change_of_wind(6, 12));
  bench_.run_to(9);
  const link_t before = row_at(5), at = row_at(6), after = row_at(9);
  EXPECT_EQ(row_at(1).noise_level_db, before.noise_level_db);
  EXPECT_GT(at.noise_level_db, before.noise_level_db + 10);  // 7.5 sqrt(12) dB more, where wind leads
  EXPECT_EQ(at.noise_level_db, after.noise_level_db);
  EXPECT_NEAR(at.snr_db - before.snr_db, before.noise_level_db - at.noise_level_db, 1e-9);
  EXPECT_LT(at.capacity_bps, before.capacity_bps);
  EXPECT_EQ(at.received_level_db, before.received_level_db);
  EXPECT_EQ(at.delay_s, before.delay_s);
}

TEST_F(EnvironmentChangeNodeTest, TheEnvironmentIsPublishedAtTheChange) {
  two_at_rest();
  bench_.run_to(2);
  bench_.change(bench_.change_of_wind(5.25, 12));
  bench_.run_to(9);
  ASSERT_EQ(bench_.environments.size(), 2u);
  EXPECT_EQ(bench_.environments[0].wind_speed_mps, 0);
  EXPECT_EQ(bench_.environments[1].utime, 5'250'000);
  EXPECT_EQ(bench_.environments[1].wind_speed_mps, 12);
}

TEST_F(EnvironmentChangeNodeTest, AChangeReceivedLateHoldsFromItsReception) {
  two_at_rest();
  bench_.run_to(6.5);
  bench_.change(bench_.change_of_wind(3, 12));
  bench_.run_to(9);
  EXPECT_EQ(row_at(6).noise_level_db, row_at(2).noise_level_db);
  EXPECT_GT(row_at(7).noise_level_db, row_at(6).noise_level_db + 10);
  EXPECT_EQ(bench_.environments.back().utime, 6'500'000);
}

TEST_F(EnvironmentChangeNodeTest, AnotherProfileMovesDelayByItsSpeed) {
  two_at_rest();
  bench_.run_to(2);
  environment_change_t change = bench_.change_of_wind(5, 0);
  change.sets_wind = 0;
  change.profile_set = environment_change_t::PROFILE_SPEED;
  change.num_layers = 1;
  change.layer_depth_m = {0};
  change.layer_sound_speed_mps = {1450};
  change.layer_temperature_degc = {10};
  change.layer_salinity_psu = {35};
  bench_.change(change);
  bench_.run_to(6);
  EXPECT_NEAR(row_at(4).delay_s, 500 / 1500.0, 1e-9);
  EXPECT_NEAR(row_at(5).delay_s, 500 / 1450.0, 1e-9);
  EXPECT_EQ(row_at(5).noise_level_db, row_at(4).noise_level_db);
}

TEST_F(EnvironmentChangeNodeTest, APacketGoesThroughTheWaterOfItsDeparture) {
  two_at_rest();
  bench_.run_to(2);
  environment_change_t change = bench_.change_of_wind(5, 0);
  change.sets_wind = 0;
  change.profile_set = environment_change_t::PROFILE_SPEED;
  change.num_layers = 1;
  change.layer_depth_m = {0};
  change.layer_sound_speed_mps = {1450};
  change.layer_temperature_degc = {10};
  change.layer_salinity_psu = {35};
  bench_.change(change);
  bench_.send(1, 4.9, 0);
  bench_.send(1, 5, 1);
  bench_.run_to(8);
  ASSERT_EQ(bench_.outcomes.size(), 2u);
  EXPECT_NEAR(bench_.outcomes[0].travel_time_s, 500 / 1500.0, 1e-6);
  EXPECT_NEAR(bench_.outcomes[1].travel_time_s, 500 / 1450.0, 1e-6);
}

// 0.333 s under way: the wind rises between departure and arrival.
TEST_F(EnvironmentChangeNodeTest, WindThatRisesWhileAPacketIsUnderWayMovesItsNoise) {
  two_at_rest();
  bench_.run_to(2);
  bench_.change(bench_.change_of_wind(5, 12));
  for (const double departure_s : {4.5, 4.9, 5.5}) {  // arrives before, arrives after, all after
    bench_.send(1, departure_s, static_cast<std::int64_t>(10 * departure_s));
  }
  bench_.run_to(8);
  ASSERT_EQ(bench_.outcomes.size(), 3u);
  const packet_outcome_t &calm = bench_.outcomes[0], &between = bench_.outcomes[1],
                         &windy = bench_.outcomes[2];
  EXPECT_EQ(calm.noise_level_db, row_at(4).noise_level_db);
  EXPECT_EQ(between.noise_level_db, row_at(6).noise_level_db);
  EXPECT_EQ(windy.noise_level_db, between.noise_level_db);
  EXPECT_NEAR(between.snr_db - calm.snr_db, calm.noise_level_db - between.noise_level_db, 1e-9);
}

TEST_F(EnvironmentChangeNodeTest, AnImpossibleChangeIsRefusedAndNothingMoves) {
  two_at_rest();
  bench_.run_to(2);
  bench_.change(bench_.change_of_wind(3, 75));
  bench_.run_to(6);
  EXPECT_EQ(row_at(6).noise_level_db, row_at(2).noise_level_db);
  EXPECT_EQ(bench_.environments.size(), 1u);
}

class RayNodeTest : public EnvironmentChangeNodeTest {
 protected:
  RayNodeTest() : rays_({}, {testing::quick_modem(), {}}, ray_model(testing::even_water(), {}, {})) {}
  void two_at_rest(double end_s = 20) {
    for (double t = 0; t <= end_s; t += 0.5) {
      rays_.state(1, t, {0, 0, 50});
      rays_.state(2, t, {500, 0, 50});
    }
  }
  link_t row() { return rays_.last_table(1).peers.at(0); }
  NodeBench rays_;
};

TEST_F(RayNodeTest, TheFirstRowKnowsTheBottom) {
  FlatBottom bottom(rays_.lcm(), 100);
  two_at_rest();
  rays_.run_to(1);
  EXPECT_EQ(row().propagation_used, link_t::USED_RAYS);
  EXPECT_EQ(row().multipath, link_t::MULTIPATH_LIKELY);
  EXPECT_GT(row().num_paths, 4);
  EXPECT_GT(row().delay_spread_s, 0);
  EXPECT_EQ(row().path_state, link_t::PATH_OPEN);
}

TEST_F(RayNodeTest, AVehicleAtRestIsQueriedOnce) {
  FlatBottom bottom(rays_.lcm(), 100);
  two_at_rest();
  rays_.run_to(14);
  ASSERT_EQ(bottom.queries().size(), 1u);
  EXPECT_EQ(bottom.queries()[0].query_mode, ray_query_t::DEPTH_TILES);
}

TEST_F(RayNodeTest, WithoutTheServicePathsAreStraightAndRaysComeBackByThemselves) {
  FlatBottom bottom(rays_.lcm(), 100);
  bottom.set_away(true);
  two_at_rest();
  rays_.run_to(5);
  EXPECT_EQ(row().propagation_used, link_t::USED_STRAIGHT_WITHOUT_BOTTOM);
  bottom.set_away(false);
  rays_.run_to(8);
  EXPECT_EQ(row().propagation_used, link_t::USED_RAYS);
}

TEST_F(RayNodeTest, AQueryBetweenPositionsWaitsForTheBottom) {
  FlatBottom bottom(rays_.lcm(), 100);
  rays_.bus().publish("LINK_QUERY", testing::link_query({{testing::at(0, 50), testing::at(500, 50)}}, 5));
  rays_.step(0, /*known=*/false);
  ASSERT_EQ(rays_.replies.size(), 1u);
  EXPECT_EQ(rays_.replies[0].message.answers.at(0).link.propagation_used, link_t::USED_RAYS);
  EXPECT_EQ(rays_.replies[0].message.answers.at(0).getml_multipath, link_t::MULTIPATH_LIKELY);
}

// Wind takes from bounces at the surface, but of the sound that leaves after it has risen.
TEST_F(RayNodeTest, WindThatRisesWhileAPacketIsUnderWayLeavesItsPathsAlone) {
  FlatBottom bottom(rays_.lcm(), 100);
  two_at_rest();
  rays_.run_to(2);
  rays_.change(rays_.change_of_wind(5, 12));
  for (const double departure_s : {4.5, 4.9, 5.5}) {
    rays_.send(1, departure_s, static_cast<std::int64_t>(10 * departure_s));
  }
  rays_.run_to(8);
  ASSERT_EQ(rays_.outcomes.size(), 3u);
  const packet_outcome_t &calm = rays_.outcomes[0], &between = rays_.outcomes[1], &windy = rays_.outcomes[2];
  EXPECT_EQ(between.received_level_db, calm.received_level_db);
  EXPECT_EQ(between.num_paths, calm.num_paths);
  EXPECT_EQ(between.travel_time_s, calm.travel_time_s);
  EXPECT_EQ(between.delay_spread_s, calm.delay_spread_s);
  EXPECT_GT(between.noise_level_db, calm.noise_level_db + 10);
  EXPECT_LT(windy.received_level_db, between.received_level_db);
  EXPECT_LT(windy.num_paths, between.num_paths);
}

TEST_F(RayNodeTest, ATideMovesDepthsAndSoThePaths) {
  FlatBottom bottom(rays_.lcm(), 100);
  two_at_rest();
  environment_change_t tide = rays_.change_of_wind(5, 0);
  tide.sets_wind = 0;
  tide.sets_sea_surface = 1;
  tide.sea_surface_z_m = -3;
  rays_.run_to(2);
  rays_.change(tide);
  rays_.run_to(4);
  const link_t before = row();
  rays_.run_to(5);
  EXPECT_NE(row().received_level_db, before.received_level_db);  // echoes off the surface take longer
  EXPECT_NEAR(row().delay_s, before.delay_s, 1e-9);              // the direct path does not
  EXPECT_EQ(rays_.environments.back().sea_surface_z_m, -3);
}

TEST_F(RayNodeTest, TheEnvironmentNamesRaysSurfaceAndBottom) {
  two_at_rest(2);
  rays_.run_to(1);
  const environment_t& published = rays_.environments.front();
  EXPECT_EQ(published.propagation_model, "rays");
  EXPECT_EQ(published.surface_model, "apl-bubbles");
  EXPECT_EQ(published.bottom_density_ratio, acoustics::FluidBottom().density_ratio);
}

}  // namespace
}  // namespace halocline::channel_server
