// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ensemble/sea_member.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/math/functions.h"
#include "channel_server/channel_server_config.h"
#include "simulation/composition.h"
#include "simulation/ensemble/key_changes.h"
#include "simulation/ensemble/link_ensemble.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

ScenarioConfig shallow_sea() {
  ScenarioConfig config;
  config.scenario.vehicles.resize(1);
  config.scenario.vehicles[0].name = "a";
  config.scenario.vehicles[0].id = 1;
  config.scenario.vehicles[0].start_ned_m = {0, 0, 20};
  config.terrain.flat.depth_m = 50;
  return config;
}

TEST(SeaMember, EachNumberTakesEachStratumOnce) {
  constexpr std::size_t kMembers = 20;
  for (const auto number :
       {&MemberDraws::first_mode, &MemberDraws::second_mode, &MemberDraws::wind, &MemberDraws::noise,
        &MemberDraws::receiver, &MemberDraws::bottom, &MemberDraws::sediment}) {
    std::vector<double> values;
    for (std::size_t i = 0; i < kMembers; ++i) values.push_back(draws_of(7, i, kMembers).*number);
    std::sort(values.begin(), values.end());
    for (std::size_t i = 0; i < kMembers; ++i)
      EXPECT_EQ(values[i], acoustics::normal_quantile((static_cast<double>(i) + 0.5) / kMembers));
  }
}

TEST(SeaMember, IsThatOfItsSeed) {
  EXPECT_EQ(draws_of(1, 3, 20).noise, draws_of(1, 3, 20).noise);
  double differ = 0;
  for (std::size_t i = 0; i < 20; ++i)
    differ += std::abs(draws_of(1, i, 20).noise - draws_of(2, i, 20).noise);
  EXPECT_GT(differ, 1);
}

TEST(SeaMember, KeysMoveByTheirSpreads) {
  ScenarioConfig config = shallow_sea();
  const MemberDraws up{.first_mode = 1, .wind = 1, .noise = 1, .receiver = -1, .bottom = 1, .sediment = 1};
  const auto member = member_of(config, up, 50, 25'000).channel_server;
  const auto& before = config.channel_server;
  EXPECT_DOUBLE_EQ(member.environment.noise.wind_mps, 1.2 * before.environment.noise.wind_mps);
  EXPECT_DOUBLE_EQ(member.environment.noise.offset_db, 5);
  EXPECT_DOUBLE_EQ(member.rules.receiver_margin_db, -2);
  EXPECT_NEAR(member.propagation.fading.bottom_roughness_m, 2 * before.propagation.fading.bottom_roughness_m,
              1e-12);
  EXPECT_NE(member.propagation.sediment, before.propagation.sediment);
  EXPECT_DOUBLE_EQ(member.environment.profile_modes.first_mps, 0.3);
  EXPECT_DOUBLE_EQ(member.environment.profile_modes_depth_m, 50);
}

// Above 40 kHz nothing of the table of places was measured.
TEST(SeaMember, NoiseOfHighFrequenciesIsLessCertain) {
  const ScenarioConfig config = shallow_sea();
  const MemberDraws loud{.noise = 1};
  EXPECT_DOUBLE_EQ(member_of(config, loud, 50, 69'000).channel_server.environment.noise.offset_db, 10);
}

TEST(SeaMember, NoiseAndBottomAreCorrelatedAsStated) {
  ScenarioConfig config = shallow_sea();
  config.uncertainty.noise_bottom_correlation = -1;
  const MemberDraws loud{.noise = 1};
  const auto member = member_of(config, loud, 50, 25'000).channel_server;
  EXPECT_NEAR(member.propagation.fading.bottom_roughness_m,
              0.5 * config.channel_server.propagation.fading.bottom_roughness_m, 1e-12);
}

TEST(SeaMember, WithoutSpreadsIsTheSceneItself) {
  ScenarioConfig config = shallow_sea();
  config.uncertainty = {.noise_db = 0,
                        .receiver_db = 0,
                        .bottom_octaves = 0,
                        .wind_share = 0,
                        .sediment_rows = 0,
                        .profile_mps = 0};
  const LinkSurveyEnd from = link_end(config, "a"), to = link_end(config, "1000,0,30");
  const LinkSurvey one = survey_link(config, from, to);
  const LinkBands bands = link_bands(config, from, to, 3);
  EXPECT_NEAR(bands.snr_db.low, one.reception.budget.snr.value, 1e-9);
  EXPECT_NEAR(bands.snr_db.high, one.reception.budget.snr.value, 1e-9);
  EXPECT_NEAR(bands.delivery.median, one.forecast.delivery_probability, 1e-9);
}

// Noise of 5 dB alone: 10 and 90 % of a normal distribution are 1.28 deviations away. Between two of twenty
// strata the interpolated quantile is within 0.015 deviations.
TEST(LinkEnsemble, BandOfTheNoiseIsThatOfItsSpread) {
  ScenarioConfig config = shallow_sea();
  config.uncertainty = {.noise_db = 5,
                        .receiver_db = 0,
                        .bottom_octaves = 0,
                        .wind_share = 0,
                        .sediment_rows = 0,
                        .profile_mps = 0};
  const LinkSurveyEnd from = link_end(config, "a"), to = link_end(config, "1000,0,30");
  const LinkBands bands = link_bands(config, from, to, 20);
  EXPECT_NEAR(bands.snr_db.high - bands.snr_db.low, 2 * 1.2816 * 5, 0.5);
  EXPECT_NEAR(bands.level_db.high, bands.level_db.low, 1e-9);
}

// A margin of the receivers changes what is delivered, and not what is heard.
TEST(LinkEnsemble, ReceiversMoveTheDeliveryAlone) {
  ScenarioConfig config = shallow_sea();
  const LinkSurveyEnd from = link_end(config, "a"), to = link_end(config, "1000,0,30");
  const LinkSurvey plain = survey_link(config, from, to);
  config.channel_server.rules.receiver_margin_db = plain.reception.budget.snr.value;
  const LinkSurvey worse = survey_link(config, from, to);
  EXPECT_EQ(worse.reception.budget.snr.value, plain.reception.budget.snr.value);
  EXPECT_LT(worse.forecast.sinr_db, plain.forecast.sinr_db);
}

TEST(KeyChanges, EndAtTheBoundsOfTheirKey) {
  channel_server::ChannelServerConfig config;
  change_keys(config, {scaled("propagation.bottom_roughness_m", 1e6)});
  EXPECT_EQ(number_of_key(config, "propagation.bottom_roughness_m"), 1);
}

TEST(KeyChanges, UnknownKeysHaveNoNumber) {
  const channel_server::ChannelServerConfig config;
  EXPECT_FALSE(number_of_key(config, "propagation.no_such_key").has_value());
}

TEST(KeyChanges, LeaveVehiclesWithoutAModemOfTheirOwnAsTheyAre) {
  channel_server::ChannelServerConfig config;
  config.vehicles.resize(2);
  config.vehicles[1].has_modem = true;
  config.vehicles[1].modem.modem.source_level = {150};
  change_keys(config, {added("vehicle.modem.source_level_db", 3), added("modem.source_level_db", 1)});
  EXPECT_FALSE(config.vehicles[0].has_modem);
  EXPECT_TRUE(config.vehicles[1].has_modem);
  EXPECT_DOUBLE_EQ(config.vehicles[1].modem.modem.source_level.value, 153);
}

TEST(ForecastBand, QuantilesLieBetweenTheSortedValues) {
  EXPECT_DOUBLE_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_DOUBLE_EQ(quantile({0, 10}, 0.4), 3);
  EXPECT_DOUBLE_EQ(quantile({0, 10}, 0.1), 0);
  EXPECT_DOUBLE_EQ(quantile({4}, 0.9), 4);
}

}  // namespace
}  // namespace halocline::clients
