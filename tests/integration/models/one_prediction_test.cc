// SPDX-License-Identifier: BSD-3-Clause
// `halocline link` says what the run's own tables say, whatever a scenario has.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/link_budget.h"
#include "simulation/link_survey.h"
#include "tests/integration/embedded_fixture.h"
#include "tests/support/channel_file.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

// A measured channel of -40 dB.
void write_measured_channel() {
  auto record = halocline::testing::channel_file(10, 1, 1);
  for (auto& tap : record.h_hat) tap = 0.01;
  halocline::testing::write_channel_file(record, "replayed.mat");
}

// Keys that replay it.
std::string replay_keys() {
  return "[propagation]\nreplay = \"" + halocline::testing::channel_file_folder() + "replayed.mat\"\n";
}

struct Feature {
  std::string name, text;  // `text` comes before the vehicles
  std::string of_c = "";   // keys of vehicle c
};

class OnePrediction : public testing::EmbeddedTest, public ::testing::WithParamInterface<Feature> {};

TEST_P(OnePrediction, OfLinkAndOfTheRunsTables) {
  write_measured_channel();
  const Feature& feature = GetParam();
  std::string text = "[scenario]\nduration_s = 2.5\n" + feature.text;
  for (const auto& [name, place] :
       {std::pair("a", "[0.0, 0.0, 30.0]"), {"b", "[1800.0, 0.0, 60.0]"}, {"c", "[900.0, 700.0, 45.0]"}}) {
    text += std::string("[[vehicle]]\nname = \"") + name + "\"\nid = " + std::to_string(name[0] - 'a' + 1) +
            "\nmodel = \"fixed\"\nstart_ned_m = " + place + "\n";
  }
  ScenarioConfig config = load_text(text + feature.of_c);
  config.channel_server.propagation.rays.reuse_distance_m = 0;  // each link is searched for itself
  // The slow sea of the tables is that of 2 s, the links' that of 0 s.
  config.channel_server.propagation.fading.slow = {};
  config.channel_server.environment.noise_variation.spread_db = 0;
  int compared = 0;
  for (const auto& [channel, table] : messages_in<link_table_t>(run(config, "prediction"))) {
    if (table.utime != 2'000'000) continue;
    for (const link_t& row : table.peers) {
      const std::string from(1, static_cast<char>('a' + row.transmitter_id - 1)),
          to(1, static_cast<char>('a' + row.receiver_id - 1));
      const LinkSurvey link = survey_link(config, link_end(config, from), link_end(config, to));
      const acoustics::LinkBudget& budget = link.reception.budget;
      EXPECT_NEAR(budget.received_level.value, row.received_level_db, tolerance(1e-6)) << from << to;
      EXPECT_NEAR(budget.noise_level.value, row.noise_level_db, tolerance(1e-6)) << from << to;
      EXPECT_NEAR(budget.delay_s, row.delay_s, tolerance(1e-9)) << from << to;
      EXPECT_NEAR(link.forecast.delivery_probability, row.delivery_probability, tolerance(1e-6))
          << from << to;
      EXPECT_EQ(static_cast<int>(link.reception.used), row.propagation_used) << from << to;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 6);
}

INSTANTIATE_TEST_SUITE_P(
    Scenarios, OnePrediction,
    ::testing::Values(
        Feature{"Plain", ""}, Feature{"MeasuredChannels", replay_keys()},
        Feature{"LevelsOfMeasuredChannels", replay_keys() + "replay_level = \"file\"\n"},
        Feature{"NoiseOfAVehicle", "",
                "[vehicle.noise]\nlevel_db = [150.0, 140.0]\nvaries_with = \"nothing\"\n"},
        Feature{"Beams", "[modem]\nbeam_elevation_deg = [-30.0, 30.0]\nbeam_loss_db = [20.0, 0.0]\n"},
        Feature{"DirectivityIndex", "[modem]\ndirectivity_index_db = 6.0\n"},
        Feature{"AModemOfItsOwn", "", "[vehicle.modem]\nsource_level_db = 150.0\nguard_time_s = 0.001\n"},
        Feature{"WindAndRain", "[environment]\nwind_mps = 14.0\nrain_mm_per_h = 10.0\n"},
        Feature{"NoiseOfAPlace", "[environment]\nnoise_place = \"reef\"\n"},
        Feature{"NoiseOfASite", "[environment]\nsite_noise = [[1.0, 70.0], [20.0, 52.0], [80.0, 45.0]]\n"},
        Feature{"ALoadOfTheWater", "[water_load]\nparticles_kg_m3 = 0.1\nplants_db_per_km = 2.0\n"},
        Feature{"AChangeFromTheStart", "[[environment_change]]\nat_s = 0.0\nwind_mps = 16.0\n"},
        Feature{"NoFading", "[propagation]\nfading = \"none\"\n"},
        Feature{"StraightThroughARidge",
                "[propagation]\nmodel = \"straight\"\n[terrain]\nkind = "
                "\"ridge\"\n[terrain.ridge]\nazimuth_deg = 90.0\n"
                "crest_north_m = 400.0\ndepth_m = 100.0\nheight_m = 90.0\nhalf_width_m = 100.0\n"},
        Feature{"ASlope", "[terrain]\nkind = \"slope\"\n"},
        Feature{"BeyondTheArea", "[terrain]\nsize_north_m = 400.0\nsize_east_m = 400.0\n"}),
    [](const auto& info) { return info.param.name; });

class MeasuredPrediction : public testing::EmbeddedTest {};

// A measured channel of -40 dB whose level is the file's delivers everything over a way that the model calls
// lost.
TEST_F(MeasuredPrediction, AMeasuredChannelDeliversInTheRunAndInThePrediction) {
  write_measured_channel();
  const ScenarioConfig config =
      load_text("[scenario]\nduration_s = 60.0\n" + replay_keys() +
                "replay_level = \"file\"\n"
                "[[vehicle]]\nname = \"a\"\nid = 1\nmodel = \"fixed\"\nstart_ned_m = [0.0, 0.0, "
                "30.0]\n[vehicle.traffic]\n"
                "period_s = 6.0\ndestination = \"b\"\n"
                "[[vehicle]]\nname = \"b\"\nid = 2\nmodel = \"fixed\"\nstart_ned_m = [1500.0, 0.0, 30.0]\n");
  const LinkSurvey link = survey_link(config, link_end(config, "a"), link_end(config, "b"));
  EXPECT_GT(link.forecast.delivery_probability, 0.99);
  EXPECT_EQ(link.arrivals.found_by, "measured");
  int outcomes = 0;
  for (const auto& [channel, outcome] : messages_in<packet_outcome_t>(run(config, "measured"))) {
    EXPECT_EQ(outcome.outcome, packet_outcome_t::RECEIVED);
    ++outcomes;
  }
  EXPECT_GE(outcomes, 8);
}

}  // namespace
}  // namespace halocline::clients
