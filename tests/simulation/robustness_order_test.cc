// SPDX-License-Identifier: BSD-3-Clause
// Order of robustness: of the rates of one maker a slower, more robust one delivers no less than a faster
// one, in six seas, in a calm, a breeze and a fresh wind, and at ranges from 200 m to 5 km.
//
// A margin of 0.03 is what predictions of two rates may differ by where both are nearly certain. The rates of
// the Micromodem's phase-shift keying are those with a gain over the next: rate 3 spreads without a code and
// needs more than the faster, coded rate 4 (tests/acoustics/modem/modem_profile_test.cc). Its frequency-shift
// keying has one hydrophone where phase-shift keying combines four: it is compared with rate 5.
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "channel_server/modems/modem_config.h"
#include "simulation/composition.h"
#include "simulation/link_survey.h"
#include "tests/simulation/plain_seas.h"

namespace halocline::clients {
namespace {

using halocline::testing::link_over;
using halocline::testing::PlainSea;

constexpr double kMargin = 0.03;

class Robustness : public ::testing::TestWithParam<std::tuple<PlainSea, double>> {};

TEST_P(Robustness, OfASlowerRateOfOneMakerIsNoLess) {
  PlainSea sea = std::get<0>(GetParam());
  sea.wind_mps = std::get<1>(GetParam());
  const ScenarioConfig config = sea.scenario();
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
      const LinkSurvey link =
          link_over(config, range_m, sea.end_m, sea.end_m, channel_server::load_modem(profile));
      return known[profile] = link.forecast.delivery_probability;
    };
    for (const std::vector<std::string>& rates : makers) {
      for (std::size_t i = 1; i < rates.size(); ++i) {
        EXPECT_LE(delivery(rates[i]), delivery(rates[i - 1]) + kMargin)
            << rates[i] << " and " << rates[i - 1] << " at " << range_m << " m";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seas, Robustness,
                         ::testing::Combine(::testing::ValuesIn(halocline::testing::plain_seas()),
                                            ::testing::Values(0.0, 5.0, 10.0)),
                         [](const auto& of) {
                           const auto wind_mps = static_cast<int>(std::get<1>(of.param));
                           return std::get<0>(of.param).name + "_wind_" + std::to_string(wind_mps);
                         });

}  // namespace
}  // namespace halocline::clients
