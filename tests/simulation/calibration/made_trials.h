// SPDX-License-Identifier: BSD-3-Clause
// Trials of our own making, from a sea whose numbers are known: eight pairs over three days, in bins of two
// hours.
//
// Pair i delivers Phi((margin_i - d - loss_i ln b) / 4 dB) with d more noise and a bottom factor b. A packet
// every six minutes is decided by itself; the slow sea is a Gauss-Markov level of 6 h of each pair and one of
// 1 h for all, of equal variance.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/random.h"
#include "simulation/calibration/delivery_curve.h"
#include "simulation/calibration/trial_data.h"
#include "simulation/calibration/trial_forecast.h"
#include "simulation/calibration/trial_likelihood.h"

namespace halocline::clients::testing {

// Numbers that the sea of a trial has beside those of the forecasts.
struct MadeSea {
  double offset_db = 0, ln_bottom = 0, slow_db = 4.2;
};

inline constexpr std::size_t kMadePairs = 8;
inline constexpr std::array<double, kMadePairs> kMarginsDb{14, 11, 8, 6, 4, 2, -1, -4};
inline constexpr std::array<double, kMadePairs> kLossesDb{0, 0.5, 1, 2,
                                                          3, 4,   6, 8};  // of a bottom e times as rough
inline constexpr double kCurveDb = 4;

inline double made_delivery(std::size_t pair, double more_noise_db, double ln_bottom) {
  const double margin_db = kMarginsDb[pair] - more_noise_db - kLossesDb[pair] * ln_bottom;
  return DeliveryCurve::delivery_of(margin_db / kCurveDb);
}

inline PairForecast made_forecast(std::size_t pair) {
  PairForecast forecast;
  for (std::size_t k = 0; k < kLnFactors.size(); ++k) {
    forecast.snr_db[k] = 10 + kMarginsDb[pair] - kLossesDb[pair] * kLnFactors[k];
    forecast.level_db[k] = 60 + forecast.snr_db[k];
    forecast.by_bottom[k] =
        DeliveryCurve([&](double noise_db) { return made_delivery(pair, noise_db, kLnFactors[k]); }).scores();
    forecast.by_echo[k] = forecast.by_bottom[k];
  }
  forecast.by_echo.fill(forecast.by_bottom[kLnFactors.size() / 2]);
  return forecast;
}

// Returns the pairs with their packets; `with_snr` adds an SNR to each bin, measured where noise is
// `offset_db` up.
inline std::vector<ForecastPair> made_trial(std::uint64_t seed, const MadeSea& sea, bool with_snr = false) {
  constexpr std::size_t kPackets = 720;  // in three days
  constexpr double kEveryS = 360, kBinS = 7200;
  const auto normal = [&](const char* purpose, std::size_t who, std::size_t which) {
    return normal_at({seed, purpose_of(purpose), static_cast<std::uint32_t>(who), which});
  };
  const auto walk = [&](const char* purpose, std::size_t who, double time_s) {
    std::vector<double> values{normal(purpose, who, 0)};
    const double kept = std::exp(-kEveryS / time_s);
    for (std::size_t i = 1; i < kPackets; ++i)
      values.push_back(kept * values.back() + std::sqrt(1 - kept * kept) * normal(purpose, who, i));
    return values;
  };
  const std::vector<double> noise = walk("noise", 0, 3600);
  std::vector<ForecastPair> pairs;
  for (std::size_t p = 0; p < kMadePairs; ++p) {
    const std::vector<double> fading = walk("fading", p + 1, 21'600);
    std::map<std::int64_t, TrialBin> bins;
    for (std::size_t i = 0; i < kPackets; ++i) {
      const double slow_db = sea.slow_db / std::sqrt(2.0) * (noise[i] + fading[i]);
      const auto window = static_cast<std::int64_t>(static_cast<double>(i) * kEveryS / kBinS);
      TrialBin& bin = bins[window];
      bin.window = window;
      ++bin.sent;
      const double draw = uniform_at({seed, purpose_of("packet"), static_cast<std::uint32_t>(p), i});
      if (draw < made_delivery(p, sea.offset_db + slow_db, sea.ln_bottom)) ++bin.received;
      if (with_snr && bin.snrs == 0) {
        bin.snrs = 1;
        bin.snr_db = 10 + kMarginsDb[p] - kLossesDb[p] * sea.ln_bottom - sea.offset_db - slow_db +
                     kLevelSpreadDb * normal("snr", p, i);
      }
    }
    ForecastPair pair{{"s", "r" + std::to_string(p), {}}, {made_forecast(p)}, {}, {}};
    for (const auto& [window, bin] : bins) pair.trial.bins.push_back(bin);
    pair.forecast_of.assign(pair.trial.bins.size(), 0);
    pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace halocline::clients::testing
