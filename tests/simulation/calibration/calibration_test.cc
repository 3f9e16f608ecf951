// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/calibration.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "channel_server/channel_server_config.h"
#include "simulation/calibration/calibration_output.h"
#include "simulation/composition.h"
#include "simulation/uncertainty_config.h"
#include "tests/simulation/calibration/made_trials.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;
using testing::made_trial;
using testing::MadeSea;

constexpr double kFrequencyHz = 25'000;

// studies/validate_calibration sets 50.
std::uint64_t trials() {
  const char* given = std::getenv("HALOCLINE_TRIALS");
  return given != nullptr ? std::strtoull(given, nullptr, 10) : 6;
}

// sea.md's bars: the offset within 1.5 dB rms, slow_db within 30 %, bands of 80 % hold 70 to 90 % of pairs
// left out. Over 50 trials 0.97 dB, 13 % and 78 % were measured; the share of few trials scatters by some 6
// %.
TEST(Calibration, FindsTheNumbersOfASeaOfOurOwnMaking) {
  const MadeSea sea{.offset_db = 3, .ln_bottom = 0.4, .slow_db = 4.2};
  double offset = 0, slow = 0;
  std::size_t inside = 0, pairs = 0;
  for (std::uint64_t seed = 0; seed < trials(); ++seed) {
    const Calibration found = calibrate_forecasts(made_trial(seed, sea), kFrequencyHz, true, false);
    ASSERT_NE(found.told(kNoiseDb), nullptr);
    ASSERT_NE(found.told(kLnSlowDb), nullptr);
    offset += std::pow(found.told(kNoiseDb)->value - sea.offset_db, 2);
    slow += std::pow(std::log(found.told(kLnSlowDb)->value / sea.slow_db), 2);
    for (const PairCheck& check : found.checks) inside += check.is_inside() ? 1 : 0;
    pairs += found.checks.size();
  }
  const auto count = static_cast<double>(trials());
  EXPECT_LT(std::sqrt(offset / count), tolerance(1.5));
  EXPECT_LT(std::sqrt(slow / count), tolerance(0.26));
  const double share = static_cast<double>(inside) / static_cast<double>(pairs);
  std::printf("offset %.2f dB rms, slow %.0f %%, inside %.0f %%\n", std::sqrt(offset / count),
              100 * std::sqrt(slow / count), 100 * share);
  const double room = trials() < 50 ? 0.1 : 0;
  EXPECT_GE(share, 0.7 - room);
  EXPECT_LE(share, 0.9 + room);
}

TEST(Calibration, PacketsAloneDoNotSplitNoiseFromReceivers) {
  const Calibration found = calibrate_forecasts(made_trial(1, {.offset_db = 3}), kFrequencyHz, true, false);
  EXPECT_EQ(found.told(kReceiverDb), nullptr);
  EXPECT_EQ(found.numbers.front().name, "offset_db");
}

// The made receivers are as forecast, so the noise has all of the offset.
TEST(Calibration, SnrsSplitNoiseFromReceivers) {
  const auto pairs = made_trial(2, {.offset_db = 4}, /*with_snr=*/true);
  const Calibration found = calibrate_forecasts(pairs, kFrequencyHz, true, false);
  ASSERT_NE(found.told(kNoiseDb), nullptr);
  EXPECT_NEAR(found.told(kNoiseDb)->value, 4, 2);
  ASSERT_FALSE(found.numbers.empty());
  EXPECT_EQ(found.numbers[1].number, kReceiverDb);
}

TEST(Calibration, FewPairsTellTheOffsetAlone) {
  auto pairs = made_trial(3, {.offset_db = 3});
  pairs.resize(2);
  const Calibration found = calibrate_forecasts(pairs, kFrequencyHz, true, false);
  EXPECT_TRUE(found.is_offset_alone);
  ASSERT_EQ(found.numbers.size(), 1U);
  EXPECT_EQ(found.numbers[0].number, kNoiseDb);
}

// Pairs that the bottom does not touch say nothing of it.
TEST(Calibration, ANumberThatTheDataDoNotTellKeepsItsPrior) {
  auto pairs = made_trial(4, {.offset_db = 2});
  for (ForecastPair& pair : pairs) {
    PairForecast& forecast = pair.forecasts.front();
    forecast.by_bottom.fill(forecast.by_bottom[kLnFactors.size() / 2]);
  }
  const Calibration found = calibrate_forecasts(pairs, kFrequencyHz, true, false);
  EXPECT_EQ(found.told(kLnBottom), nullptr);
  ASSERT_EQ(found.numbers[1].number, kLnBottom);
  EXPECT_DOUBLE_EQ(found.numbers[1].value, 1);
  EXPECT_NE(to_text(found).find("not told by these data"), std::string::npos);
}

// The keys are read again as those of a scenario, with the offset added to its own and narrower spreads.
TEST(Calibration, IsWrittenAsKeysOfAScenario) {
  ScenarioConfig config;
  config.channel_server.environment.noise.offset_db = 1;
  const Calibration found = calibrate_forecasts(made_trial(5, {.offset_db = 3}), kFrequencyHz, true, false);
  auto file = bus::ConfigFile::parse(to_toml(found, config, "trial.csv"), "calibrated.toml");
  ScenarioConfig read;
  file.read([&](bus::ConfigVisitor& v) { visit(v, read); });
  file.check(/*whole_file=*/true);
  EXPECT_NEAR(read.channel_server.environment.noise.offset_db, 1 + found.told(kNoiseDb)->value, 1e-3);
  ASSERT_TRUE(read.uncertainty.noise_db.has_value());
  EXPECT_NEAR(*read.uncertainty.noise_db, found.told(kNoiseDb)->deviation, 1e-3);
  EXPECT_LT(*read.uncertainty.noise_db, Uncertainty::kNoiseDb);
  EXPECT_EQ(read.uncertainty.receiver_db, 0);
  EXPECT_LT(read.uncertainty.bottom_octaves, 1);
}

// Numbers at the edges of what a fit may find: the keys stay within their ranges.
TEST(Calibration, WhateverItFindsCanBeReadAgain) {
  ScenarioConfig config;
  for (const double sign : {-1.0, 1.0}) {
    Calibration found;
    const auto tell = [&](SeaNumber number, double value, bool is_factor) {
      found.numbers.push_back({.number = number,
                               .is_logarithmic = is_factor,
                               .is_told = true,
                               .value = is_factor ? std::exp(sign * value) : sign * value,
                               .deviation = 0.5,
                               .prior_deviation = 1,
                               .fitted_deviation = 0.5});
    };
    tell(kNoiseDb, 100, false);
    tell(kReceiverDb, 50, false);
    tell(kLnBottom, 6, true);
    tell(kLnSlowDb, 6, true);
    tell(kLnEcho, 6, true);
    auto file = bus::ConfigFile::parse(to_toml(found, config, "trial.csv"), "calibrated.toml");
    ScenarioConfig read;
    EXPECT_NO_THROW({
      file.read([&](bus::ConfigVisitor& v) { visit(v, read); });
      file.check(/*whole_file=*/true);
    }) << to_toml(found, config, "trial.csv");
    EXPECT_EQ(read.channel_server.calibration.loss_db, sign < 0 ? -20 : 40);
  }
}

// The numbers hold for the modems that vehicles have of their own, too: scaled echoes cost a link between
// them what they cost one of [modem].
TEST(Calibration, EchoesAreThoseOfVehiclesWithModemsOfTheirOwn) {
  const auto config_of = [](const std::string& modems) {
    auto file = bus::ConfigFile::parse("[terrain]\nkind = \"flat\"\n[terrain.flat]\ndepth_m = 20\n" + modems,
                                       "own.toml");
    ScenarioConfig config;
    file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
    file.check(/*whole_file=*/true);
    return config;
  };
  const auto vehicle = [](const char* name, int id, const std::string& modem) {
    return std::string("[[vehicle]]\nname = \"") + name + "\"\nid = " + std::to_string(id) +
           "\nmodel = \"fixed\"\nstart_ned_m = [" + std::to_string(1500.0 * id) + ", 0.0, 15.0]\n" + modem;
  };
  const std::string own = "[vehicle.modem]\nprofile = \"unet-data\"\n";
  const ScenarioConfig with_own = config_of(vehicle("a", 1, own) + vehicle("b", 2, own)),
                       shared = config_of("[modem]\nprofile = \"unet-data\"\n" + vehicle("a", 1, "") +
                                          vehicle("b", 2, ""));
  const auto pairs = pairs_of({{.from = "a", .to = "b", .sent = 1}}, 7200);
  const PairForecast one = pair_forecasts(with_own, pairs, {0}, {{0}})[0][0],
                     other = pair_forecasts(shared, pairs, {0}, {{0}})[0][0];
  EXPECT_EQ(one.by_echo, other.by_echo);
  EXPECT_NE(one.by_echo.front(), one.by_echo.back());
}

// A whole chain on a small scenario: as many packets as the forecast says leave the offset near 0.
TEST(Calibration, OfAScenarioWithoutMistakesIsNearNothing) {
  ScenarioConfig config;
  config.terrain.flat.depth_m = 50;
  config.channel_server.propagation.model = channel_server::PropagationModel::kStraight;
  std::vector<TrialRow> rows;
  for (const char* to : {"1000,0,20", "3000,0,20", "5000,0,20"})
    for (int i = 0; i < 12; ++i)
      rows.push_back({.time_s = 7200.0 * i, .from = "0,0,20", .to = to, .level_db = 0});
  const auto pairs = pairs_of(rows, 7200);
  const auto forecasts = pair_forecasts(config, pairs, {0}, {{0}, {0}, {0}});
  for (TrialRow& row : rows) {
    const auto at = row.to[0] == '1' ? 0U : row.to[0] == '3' ? 1U : 2U;
    row.snr_db = forecasts[at][0].snr_db[2];
    row.level_db.reset();
  }
  const Calibration found = calibrate(config, rows);
  ASSERT_NE(found.told(kNoiseDb), nullptr);
  EXPECT_NEAR(found.told(kNoiseDb)->value, 0, 0.2);
}

TEST(TrialLikelihood, SlowTermsOfLongBinsPassWithinThem) {
  const SlowTimes short_bins{.bin_s = 1, .fading_s = 21'600, .noise_s = 3600};
  EXPECT_NEAR(short_bins.kept_in_bins(), 1, 1e-3);
  // 2 (u - 1 + exp(-u)) / u^2 at u = 1/3 and 2: 0.8985 and 0.5677.
  EXPECT_NEAR(SlowTimes().kept_in_bins(), 0.5 * (0.8985 + 0.5677), 1e-3);
}

// The score of Phi(x / w) is straight, so a normal spread widens it to Phi(x / sqrt(w^2 + spread^2)).
TEST(TrialLikelihood, WidensAStraightCurveExactly) {
  const DeliveryCurve curve([](double noise_db) { return DeliveryCurve::delivery_of(-noise_db / 4); });
  EXPECT_NEAR(widened_score(curve.scores(), -5, 3), 1, 1e-3);
}

TEST(DeliveryCurve, KeepsACurveAndItsPlateau) {
  const auto delivery = [](double noise_db) {
    return 0.6 * DeliveryCurve::delivery_of(-(noise_db - 7.3) / 3);
  };
  const DeliveryCurve curve(delivery);
  for (double noise_db = -30; noise_db < 25; noise_db += 0.5)
    EXPECT_NEAR(DeliveryCurve::delivery_of(DeliveryCurve::score_at(curve.scores(), noise_db)),
                delivery(noise_db), 0.015)
        << noise_db;
}

}  // namespace
}  // namespace halocline::clients
