// SPDX-License-Identifier: BSD-3-Clause
// How long the sound of a packet lasts at a receiver: the shortest time in which 99 % of the paths' power
// arrives, beside what measured channels have, 13 kHz. The turned sound arrives in 16 windows of equal power,
// the last of them at the mean delay of its sixteenth: 60 m away, where the oracle's last hundredth arrives
// after 11 ms, it stands at 7.7 ms.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "simulation/ensemble/sea_member.h"
#include "simulation/link_survey.h"
#include "tests/simulation/plain_seas.h"

namespace halocline::clients {
namespace {

using halocline::testing::link_over;
using halocline::testing::PlainSea;

double lasts_ms(const LinkSurvey& link) {
  std::vector<std::pair<double, double>> arrivals;  // delay, power
  double all = 0;
  for (const acoustics::Arrival& path : link.reception.paths) {
    arrivals.emplace_back(path.delay_s, std::pow(10, path.level.value / 10));
    all += arrivals.back().second;
  }
  std::sort(arrivals.begin(), arrivals.end());
  double shortest_s = std::numeric_limits<double>::infinity(), power = 0;
  std::size_t first = 0;
  for (const auto& [delay_s, arrived] : arrivals) {
    power += arrived;
    for (; power - arrivals[first].second >= 0.99 * all; ++first) power -= arrivals[first].second;
    if (power >= 0.99 * all) shortest_s = std::min(shortest_s, delay_s - arrivals[first].first);
  }
  return 1000 * shortest_s;
}

double lasts_ms(const PlainSea& sea, double range_m, double from_m, double to_m) {
  channel_server::VehicleModem modem;
  modem.modem.centre_frequency_hz = 13'000;
  ScenarioConfig config = sea.scenario();
  still_the_hours(config.channel_server);
  return lasts_ms(link_over(config, range_m, from_m, to_m, modem));
}

constexpr const char* kSummer =
    "[[0.0, 22.0, 35.0], [15.0, 22.0, 35.0], [30.0, 15.0, 35.0], [50.0, 13.0, 35.0], [100.0, 13.0, 35.0]]";

// Measured there: 27 ms; the oracle: 11, 13 and 14 ms.
TEST(Echoes, OfFifteenMetresOfFineSandLastAsMeasured) {
  const PlainSea sea{"fine", 15, 11, "[[0.0, 12.0, 35.0], [15.0, 12.0, 35.0]]", "FineSand", 6};
  for (const double range_m : {60.0, 200.0, 1000.0}) {
    const double lasts = lasts_ms(sea, range_m, 11, 12);
    EXPECT_GT(lasts, range_m == 60 ? 7 : 8) << range_m;
    EXPECT_LT(lasts, 30) << range_m;
  }
}

// Measured: 30 ms; the oracle: 47 and 38 ms at 3 and 7 km.
TEST(Echoes, BelowASummersThermoclineLastAsMeasured) {
  const PlainSea sea{"summer", 100, 60, kSummer, "FineSand"};
  for (const double range_m : {3000.0, 7000.0}) {
    const double lasts = lasts_ms(sea, range_m, 60, 60);
    EXPECT_GT(lasts, 25) << range_m;
    EXPECT_LT(lasts, 70) << range_m;
  }
}

// Measured: 40 ms; the oracle: 8 ms.
TEST(Echoes, OverMuddySandLastAsMeasured) {
  const double lasts =
      lasts_ms({"muddy", 12, 6, "[[0.0, 12.0, 35.0], [12.0, 12.0, 35.0]]", "MuddySand"}, 200, 6, 6);
  EXPECT_GT(lasts, 6);
  EXPECT_LT(lasts, 40);
}

// A known excess: off Kauai, 100 m, 3 km, 35 ms were reported. The oracle has 69 ms over fine sand and 224 ms
// over coarse sand.
TEST(Echoes, OverHardBottomsLastTooLong) {
  const auto kauai = [](const std::string& sediment) {
    return PlainSea{"kauai", 100, 60, "[[0.0, 25.0, 35.0], [100.0, 25.0, 35.0]]", sediment};
  };
  EXPECT_NEAR(lasts_ms(kauai("FineSand"), 3000, 60, 60), 77, 20);
  EXPECT_NEAR(lasts_ms(kauai("CoarseSand"), 3000, 60, 60), 224, 30);
}

}  // namespace
}  // namespace halocline::clients
