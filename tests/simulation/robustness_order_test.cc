// SPDX-License-Identifier: BSD-3-Clause
// Order of robustness: of the rates of one maker a slower, more robust one delivers no less than a faster
// one, in six seas and at ranges from 200 m to 5 km.
//
// A margin of 0.03 is what predictions of two rates may differ by where both are nearly certain. The rates of
// the Micromodem's phase-shift keying are those with a gain over the next: rate 3 spreads without a code and
// needs more than the faster, coded rate 4 (tests/acoustics/modem/modem_profile_test.cc). Its frequency-shift
// keying has one hydrophone where phase-shift keying combines four: it is compared with rate 5.
#include <array>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "channel_server/modems/modem_config.h"
#include "simulation/composition.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

constexpr double kMargin = 0.03;

struct Sea {
  const char* name;
  double depth_m, end_m;
  const char* water;
  const char* sediment;
};

constexpr std::array<Sea, 6> kSeas{{
    {"winter", 100, 60, "[[0.0, 8.0, 35.0], [100.0, 8.0, 35.0]]", "MediumSand"},
    {"summer", 100, 60,
     "[[0.0, 22.0, 35.0], [15.0, 22.0, 35.0], [30.0, 15.0, 35.0], [50.0, 13.0, 35.0], [100.0, 13.0, 35.0]]",
     "MediumSand"},
    {"tropic", 15, 7.5, "[[0.0, 29.5, 32.0], [15.0, 29.0, 32.0]]", "SandySilt"},
    {"singapore", 15, 7.5, "[[0.0, 29.0, 32.0], [15.0, 29.0, 32.0]]", "MuddySand"},
    {"harbour", 12, 6, "[[0.0, 12.0, 30.0], [12.0, 12.0, 30.0]]", "SandyMud"},
    {"deep", 3000, 60, "[[0.0, 13.0, 35.0], [300.0, 10.0, 35.0], [1000.0, 5.0, 35.0], [3000.0, 2.0, 35.0]]",
     "SandySilt"},
}};

ScenarioConfig scenario_of(const Sea& sea) {
  const auto number = [](double value) { return std::to_string(value); };
  const std::string text =
      "[scenario]\nname = \"order\"\nseed = 1\nduration_s = 60\n"
      "[terrain]\nkind = \"flat\"\nsize_north_m = 12000\nsize_east_m = 2000\n[terrain.flat]\ndepth_m = " +
      number(sea.depth_m) + "\n[environment]\nprofile = \"water-table\"\nwater_rows = " + sea.water +
      "\nwind_mps = 5\n[propagation]\nsediment = \"" + sea.sediment +
      "\"\n[[vehicle]]\nname = \"a\"\nid = 1\nmodel = \"fixed\"\nstart_ned_m = [-5500.0, 0.0, " +
      number(sea.end_m) + "]\n";
  auto file = bus::ConfigFile::parse(text, std::string(sea.name) + ".toml");
  return load_scenario(file, ScenarioUse::kWater);
}

class Robustness : public ::testing::TestWithParam<Sea> {};

TEST_P(Robustness, OfASlowerRateOfOneMakerIsNoLess) {
  const Sea& sea = GetParam();
  const ScenarioConfig config = scenario_of(sea);
  // Each from the more robust to the faster.
  const std::vector<std::vector<std::string>> makers{
      {"micromodem-psk-1", "micromodem-psk-4", "micromodem-psk-5"},
      {"micromodem-fsk", "micromodem-psk-5"},
      {"unet-control", "unet-data"},
      {"s2c-im", "s2c-burst"}};
  for (const double range_m : {200.0, 500.0, 1000.0, 2000.0, 5000.0}) {
    std::map<std::string, double> known;
    const auto delivery = [&](const std::string& profile) {
      const auto found = known.find(profile);
      if (found != known.end()) return found->second;
      LinkSurveyEnd from = link_end(config, "a"),
                    to =
                        link_end(config, std::to_string(-5500 + range_m) + ",0," + std::to_string(sea.end_m));
      from.modem = to.modem = channel_server::load_modem(profile);
      return known[profile] = survey_link(config, from, to).forecast.delivery_probability;
    };
    for (const std::vector<std::string>& rates : makers) {
      for (std::size_t i = 1; i < rates.size(); ++i) {
        EXPECT_LE(delivery(rates[i]), delivery(rates[i - 1]) + kMargin)
            << rates[i] << " and " << rates[i - 1] << " at " << range_m << " m";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seas, Robustness, ::testing::ValuesIn(kSeas),
                         [](const auto& sea) { return std::string(sea.param.name); });

}  // namespace
}  // namespace halocline::clients
