// SPDX-License-Identifier: BSD-3-Clause
// Rows state what acoustics/prediction/link_prediction.h predicts of their paths.
#include "channel_server/links/link_predictor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/slow_fading.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/prediction/reception_statistics.h"
#include "acoustics/reception/signal_history.h"
#include "core/sim_time.h"

namespace halocline::channel_server {
namespace {

using acoustics::FadingModel;
using acoustics::Modem;

constexpr FadingModel kSea{.enabled = true};

Modem modem_of(const char* family, double bit_rate_bps) {
  Modem modem;
  modem.family = family;
  modem.bit_rate_bps = bit_rate_bps;
  modem.preamble = modem.packet_overhead = SimDuration::from_milliseconds(100);
  return modem;
}

// A weak early path before two strong ones.
Reception reception_of(double noise_db) {
  const auto path = [](double delay_s, double level_db, double surface_sine_squares, int identity) {
    Arrival one{{.delay_s = delay_s, .identity = {.branch = identity}}, {level_db}};
    one.fading = path_fading(kSea, 5, 25'000, surface_sine_squares, 0.01);
    return one;
  };
  Reception reception;
  reception.paths = {path(0.9, 85, 0, 1), path(1, 100, 0.01, 2), path(1.004, 97, 0.05, 3)};
  reception.budget.noise_level = {noise_db};
  reception.budget.receivable = true;
  return reception;
}

LinkForecast forecast_of(LinkPredictor& predictor, const Modem& from, const Modem& to,
                         const Reception& reception) {
  return predictor.forecast(*predictor.rates_of(from), from, to, reception);
}

TEST(LinkPredictor, ForecastIsThePredictionOfTheReceiversWindow) {
  LinkPredictor predictor({.payload_bytes = 20, .fading = kSea, .profiles = {}});
  const Modem from = modem_of("a", 100);
  Modem to = from;
  to.directivity_index = {3};
  to.bandwidth_hz = 2500;
  const Reception reception = reception_of(105);
  const LinkForecast forecast = forecast_of(predictor, from, to, reception);
  const acoustics::Synchronisation sync{&to, best_window(reception.paths, to)};
  const double noise = std::pow(10, (105 - 3 + 10 * std::log10(2)) / 10);
  const auto predicted = predict_link(kSea, reception.paths, sync, from.band(), noise, {from, 20});
  EXPECT_EQ(forecast.first_path_delay_s, 0.9);
  EXPECT_NEAR(forecast.sinr_db, 10 * std::log10(predicted.sinr), 1e-9);
  EXPECT_NEAR(forecast.acquisition_probability, predicted.acquisition_probability, 1e-9);
  EXPECT_NEAR(forecast.delivery_probability, predicted.delivery_probability, 1e-9);
  EXPECT_GT(forecast.delivery_probability, 0.01);
  EXPECT_LT(forecast.delivery_probability, 0.99);
  EXPECT_EQ(forecast.coherence_time_s, coherence_time_s(reception.paths, sync.window));
  EXPECT_NEAR(forecast.doppler_spread_hz * forecast.coherence_time_s, 1 / (std::sqrt(2) * M_PI), 1e-12);
  EXPECT_EQ(forecast.rms_delay_spread_s, rms_delay_spread_s(reception.paths));
  EXPECT_EQ(forecast.best_rate_bps, 100);
}

// A pulse holds its energy within its chip, of which rows of tables know, too.
TEST(LinkPredictor, APulseCodeHasTheEnergyOfItsChip) {
  LinkPredictor predictor({.payload_bytes = 1, .fading = kSea, .profiles = {}});
  Modem tag = modem_of("tag", 3);
  tag.error_model = acoustics::ErrorModel::kPulses;
  tag.bandwidth_hz = 100;
  tag.chip = SimDuration::from_milliseconds(10);
  tag.preamble = tag.packet_overhead = SimDuration();
  tag.hop_count = 33;  // other paths fall between pulses
  tag.hop_clearing = SimDuration::from_milliseconds(250);
  EXPECT_GT(forecast_of(predictor, tag, tag, reception_of(60)).delivery_probability, 0.8);
  EXPECT_LT(forecast_of(predictor, tag, tag, reception_of(105)).delivery_probability, 0.1);
  // A code is not guessed: 8 pulses in noise alone are 8 false alarms of 1e-3.
  EXPECT_LT(forecast_of(predictor, tag, tag, reception_of(160)).delivery_probability, 1e-20);
}

// In impulsive noise a receiver has its further loss; it is told apart from the noise.
TEST(LinkPredictor, ImpulsesCostWhatTheReceiverLosesToThem) {
  Modem modem = modem_of("a", 100);
  modem.impulse_loss = {5};
  LinkPredictor calm({.payload_bytes = 20, .fading = kSea, .profiles = {}}),
      snapping({.payload_bytes = 20, .fading = kSea, .profiles = {}, .impulsive_noise = true});
  const Reception reception = reception_of(105);
  const LinkForecast before = forecast_of(calm, modem, modem, reception),
                     after = forecast_of(snapping, modem, modem, reception);
  EXPECT_EQ(before.powers.impulses, 0);
  EXPECT_NEAR(after.powers.noise, before.powers.noise, 1e-9 * before.powers.noise);
  EXPECT_NEAR(after.powers.impulses / before.powers.noise, std::pow(10, 0.5) - 1, 1e-9);
  EXPECT_LT(after.delivery_probability, before.delivery_probability);
}

// 30 paths 61 dB below take 0.03 dB of the ratio at most, had they been interference.
TEST(LinkPredictor, FaintPathsChangeNothing) {
  LinkPredictor predictor({.payload_bytes = 20, .fading = kSea, .profiles = {}});
  const Modem modem = modem_of("a", 100);
  Reception faint = reception_of(105), heard = reception_of(105);
  for (int i = 0; i < 30; ++i) {
    Arrival path = faint.paths[1];
    path.level = path.level - Decibels{61};
    path.delay_s += 0.01 * (i + 1);
    faint.paths.push_back(path);
  }
  const LinkForecast with = forecast_of(predictor, modem, modem, faint),
                     without = forecast_of(predictor, modem, modem, heard);
  EXPECT_EQ(with.sinr_db, without.sinr_db);
  EXPECT_EQ(with.delivery_probability, without.delivery_probability);
  EXPECT_EQ(with.coherence_time_s, without.coherence_time_s);
  EXPECT_NE(with.rms_delay_spread_s, without.rms_delay_spread_s);
}

TEST(LinkPredictor, NothingIsForecastWithoutPathsAndNothingDeliveredToAnotherFamily) {
  LinkPredictor predictor({.fading = kSea, .profiles = {}});
  const Modem modem = modem_of("a", 100);
  for (const double value : [&] {
         const LinkForecast f = forecast_of(predictor, modem, modem, Reception());
         return std::vector{f.first_path_delay_s,   f.sinr_db,          f.acquisition_probability,
                            f.delivery_probability, f.coherence_time_s, f.doppler_spread_hz,
                            f.rms_delay_spread_s,   f.best_rate_bps};
       }())
    EXPECT_EQ(value, 0);
  Reception reception = reception_of(60);
  EXPECT_GT(forecast_of(predictor, modem, modem, reception).delivery_probability, 0.5);
  reception.budget.receivable = false;
  const LinkForecast foreign = forecast_of(predictor, modem, modem_of("b", 100), reception);
  EXPECT_EQ(foreign.acquisition_probability, 0);
  EXPECT_EQ(foreign.delivery_probability, 0);
  EXPECT_EQ(foreign.best_rate_bps, 0);
  EXPECT_GT(foreign.sinr_db, 0);
}

TEST(LinkPredictor, BestRateFallsWithTheNoiseDownToNone) {
  const Modem slow = modem_of("a", 50), fast = modem_of("a", 400);
  LinkPredictor predictor({.fading = kSea, .profiles = {slow, fast, modem_of("b", 5000)}});
  const auto best = [&](const Modem& from, double noise_db) {
    return forecast_of(predictor, from, from, reception_of(noise_db)).best_rate_bps;
  };
  for (const Modem& from : {slow, fast}) {
    EXPECT_EQ(best(from, 60), 400);
    EXPECT_EQ(best(from, 100), 50);
    EXPECT_EQ(best(from, 150), 0);
  }
  EXPECT_EQ(best(modem_of("c", 70), 60), 70);
}

LinkPredictor::Rule slow_sea() {
  LinkPredictor::Rule rule{.payload_bytes = 20, .fading = kSea, .profiles = {}};
  rule.fading.slow = {.deviation_db = 3, .tidal_db = 1, .daily_db = 1};
  rule.noise = {.spread_db = 3, .spread_time_s = 3600};
  rule.seed = 5;
  return rule;
}

TEST(LinkPredictor, WithoutASlowSeaAllHoursAreAlike) {
  LinkPredictor predictor({.payload_bytes = 20, .fading = kSea, .profiles = {}});
  const Modem modem = modem_of("a", 100);
  const LinkForecast forecast = forecast_of(predictor, modem, modem, reception_of(105));
  EXPECT_EQ(forecast.delivery_low, forecast.delivery_probability);
  EXPECT_EQ(forecast.delivery_high, forecast.delivery_probability);
  const SlowState slow = predictor.slow_state(1, 2, SimTime::from_seconds(100));
  EXPECT_EQ(slow.level_db, 0);
  EXPECT_EQ(slow.margin_db, 0);
}

TEST(LinkPredictor, TheSlowStateIsThatOfPairAndNoise) {
  LinkPredictor predictor(slow_sea());
  const LinkPredictor::Rule rule = slow_sea();
  const SimTime at = SimTime::from_seconds(4000);
  const SlowState slow = predictor.slow_state(7, 2, at);
  const double level = slow_level(rule.fading.slow, {5, 2, 7}, at).value;
  EXPECT_EQ(slow.level_db, level);
  EXPECT_EQ(slow.margin_db, level - noise_offset(rule.noise, 5, at).value);
  EXPECT_EQ(predictor.slow_state(2, 7, at).level_db, level);
  EXPECT_EQ(predictor.slow_state(2, 0, at).level_db, 0);  // a position
}

// A pair that is louder by 4 dB receives as one in 4 dB less noise.
TEST(LinkPredictor, SlowFadingCountsAsLessNoise) {
  LinkPredictor predictor(slow_sea());
  const Modem modem = modem_of("a", 100);
  const auto rates = predictor.rates_of(modem);
  const LinkForecast louder = predictor.forecast(*rates, modem, modem, reception_of(105), {4, 4}),
                     quieter = predictor.forecast(*rates, modem, modem, reception_of(101));
  EXPECT_NEAR(louder.delivery_probability, quieter.delivery_probability, 1e-9);
  EXPECT_NEAR(louder.sinr_db, quieter.sinr_db, 1e-9);
}

// The quantiles over hours do not depend on the hour of the forecast: on neither the pair's level nor the
// noise, which the reception has. They are computed from four states of the medium of sixteen.
TEST(LinkPredictor, DeliveryOfOneHourInTenIsThatAtTheQuantileOfTheMargin) {
  LinkPredictor predictor(slow_sea());
  LinkPredictor still({.payload_bytes = 20, .fading = kSea, .profiles = {}});
  const Modem modem = modem_of("a", 100);
  const auto hours = acoustics::margin_quantiles(slow_sea().fading.slow, 3);
  const double noise_db = 98;
  const auto rates = predictor.rates_of(modem);
  const double
      low = forecast_of(still, modem, modem, reception_of(noise_db - hours.low_db)).delivery_probability,
      high = forecast_of(still, modem, modem, reception_of(noise_db - hours.high_db)).delivery_probability;
  EXPECT_GT(high - low, 0.3);
  for (const double level_db : {-5.0, 0.0, 3.0}) {
    for (const double sea_db : {-2.0, 0.0, 4.0}) {
      const LinkForecast now = predictor.forecast(*rates, modem, modem, reception_of(noise_db + sea_db),
                                                  {level_db, level_db - sea_db});
      EXPECT_NEAR(now.delivery_low, low, 0.04);
      EXPECT_NEAR(now.delivery_high, high, 0.04);
    }
  }
}

TEST(LinkPredictor, WithoutFadingCoherenceIsTheLongestStatedAndTheToleranceOfDopplerCounts) {
  LinkPredictor predictor({});
  Modem modem = modem_of("a", 100);
  Reception reception = reception_of(60);
  for (Arrival& path : reception.paths) path.fading = {};
  EXPECT_EQ(forecast_of(predictor, modem, modem, reception).coherence_time_s, 1e6);
  EXPECT_EQ(forecast_of(predictor, modem, modem, reception).doppler_spread_hz, 0);
  EXPECT_NEAR(forecast_of(predictor, modem, modem, reception).delivery_probability, 1, 1e-6);
  for (Arrival& path : reception.paths) path.doppler_factor = 1.01;
  modem.doppler_tolerance = 0.005;
  EXPECT_EQ(forecast_of(predictor, modem, modem, reception).delivery_probability, 0);
}

}  // namespace
}  // namespace halocline::channel_server
