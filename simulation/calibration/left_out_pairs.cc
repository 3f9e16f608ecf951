// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/left_out_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>

#include "core/elementary.h"
#include "core/random.h"
#include "simulation/calibration/delivery_curve.h"
#include "simulation/calibration/trial_data.h"
#include "simulation/calibration/trial_forecast.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kDraws = 400;
constexpr double kNormalFrom = 9;  // variance of a number of packets from which it counts as normal

// Draws of one pair's forecast.
class PairDraws {
 public:
  PairDraws(const ForecastPair& pair, std::size_t index)
      : pair_(pair), who_(static_cast<std::uint32_t>(index)), times_(pair.times) {}

  // Returns draw `j` of the quantity for these numbers.
  double at(const SeaNumbers& numbers, TrialQuantity quantity, std::size_t j) {
    draw_ = j;
    next_ = 0;
    const double all_db = elementary::exp(numbers[kLnSlowDb]), kept = times_.kept_in_bins();
    const double slow_db = all_db * std::sqrt(0.5 * kept), within_db = all_db * std::sqrt(1 - kept);
    std::vector<DeliveryCurve::Scores> scores;
    if (quantity == TrialQuantity::kDelivery)
      for (const PairForecast& forecast : pair_.forecasts)
        scores.push_back(forecast.scores_at(numbers[kLnBottom], numbers[kLnEcho]));
    double fading = normal(), noise = normal(), sum = 0, weight = 0;
    for (std::size_t i = 0; i < pair_.trial.bins.size(); ++i) {
      const TrialBin& bin = pair_.trial.bins[i];
      if (i > 0) {
        const auto apart = static_cast<double>(bin.window - pair_.trial.bins[i - 1].window) * times_.bin_s;
        fading = stepped(fading, apart / times_.fading_s);
        noise = stepped(noise, apart / times_.noise_s);
      }
      const double more_db = slow_db * (fading + noise);
      if (quantity == TrialQuantity::kDelivery) {
        const double noise_db = numbers[kNoiseDb] + numbers[kReceiverDb] + more_db;
        const double score = widened_score(scores[pair_.forecast_of[i]], noise_db, within_db);
        sum += packets(bin.sent, DeliveryCurve::delivery_of(score));
        weight += static_cast<double>(bin.sent);
      } else {
        const bool is_snr = quantity == TrialQuantity::kSnr;
        const auto rows = static_cast<double>(is_snr ? bin.snrs : bin.levels);
        if (rows == 0) continue;
        const PairForecast& forecast = pair_.forecasts[pair_.forecast_of[i]];
        const double expected =
            PairForecast::at(is_snr ? forecast.snr_db : forecast.level_db, numbers[kLnBottom]) -
            (is_snr ? numbers[kNoiseDb] : 0.0);
        sum += rows * (expected - more_db + kLevelSpreadDb / std::sqrt(rows) * normal());
        weight += rows;
      }
    }
    return weight > 0 ? sum / weight : 0;
  }

  // Standard normal numbers that belong to draw `j` alone.
  double normal_of(std::size_t j, std::size_t which) const {
    return normal_at({0, purpose_of("left-out-numbers"), who_, identity_of({j, which})});
  }

 private:
  DrawAddress address(const char* purpose) {
    return {0, purpose_of(purpose), who_, (static_cast<std::uint64_t>(draw_) << 32U) + next_++};
  }
  double normal() { return normal_at(address("left-out-sea")); }
  // A Gauss-Markov number after `steps` correlation times.
  double stepped(double value, double steps) {
    const double kept = elementary::exp(-steps);
    return kept * value + std::sqrt(1 - kept * kept) * normal();
  }
  // A number of packets out of `sent`, each with this probability.
  double packets(std::int64_t sent, double probability) {
    const auto n = static_cast<double>(sent);
    if (sent == 0) return 0;
    const bool mostly = probability > 0.5;
    const double p = mostly ? 1 - probability : probability, variance = n * p * (1 - p);
    double drawn = 0;
    if (variance > kNormalFrom) {
      drawn = std::clamp(std::round(n * p + std::sqrt(variance) * normal()), 0.0, n);
    } else {
      double left = uniform_at(address("left-out-packets")),
             term = elementary::exp(n * elementary::log1p(-p));
      while (left > term && drawn < n) {
        left -= term;
        term *= (n - drawn) / (drawn + 1) * p / (1 - p);
        ++drawn;
      }
    }
    return mostly ? n - drawn : drawn;
  }

  const ForecastPair& pair_;
  std::uint32_t who_;
  const SlowTimes& times_;
  std::size_t draw_ = 0;
  std::uint64_t next_ = 0;
};

TrialQuantity quantity_of(const TrialPair& pair) {
  if (pair.sent() > 0) return TrialQuantity::kDelivery;
  const bool has_snr =
      std::any_of(pair.bins.begin(), pair.bins.end(), [](const TrialBin& b) { return b.snrs > 0; });
  return has_snr ? TrialQuantity::kSnr : TrialQuantity::kLevel;
}

double measured_of(const TrialPair& pair, TrialQuantity quantity) {
  if (quantity == TrialQuantity::kDelivery)
    return static_cast<double>(pair.received()) / static_cast<double>(pair.sent());
  double sum = 0, weight = 0;
  for (const TrialBin& bin : pair.bins) {
    const bool is_snr = quantity == TrialQuantity::kSnr;
    const auto rows = static_cast<double>(is_snr ? bin.snrs : bin.levels);
    sum += rows * (is_snr ? bin.snr_db : bin.level_db);
    weight += rows;
  }
  return sum / weight;
}

}  // namespace

std::vector<PairCheck> check_left_out(const TrialFit& fit, const SeaPosterior& all,
                                      const std::vector<SeaNumber>& unknown,
                                      const std::vector<ForecastPair>& pairs) {
  std::vector<PairCheck> checks;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const SeaPosterior others = fit.fit_without(all, p);
    const Eigen::MatrixXd root =
        others.fitted.empty() ? Eigen::MatrixXd() : others.covariance.llt().matrixL();
    PairDraws draws(pairs[p], p);
    PairCheck check{pairs[p].trial.from, pairs[p].trial.to, quantity_of(pairs[p].trial), 0, {}};
    check.measured = measured_of(pairs[p].trial, check.quantity);
    std::vector<double> values;
    for (std::size_t j = 0; j < kDraws; ++j) {
      SeaNumbers numbers = others.numbers;
      for (std::size_t i = 0; i < others.fitted.size(); ++i)
        for (std::size_t k = 0; k <= i; ++k)
          numbers[others.fitted[i]] +=
              root(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) * draws.normal_of(j, k);
      for (const SeaNumber number : unknown)
        numbers[number] += fit.priors()[number].deviation * draws.normal_of(j, kSeaNumbers + number);
      values.push_back(draws.at(numbers, check.quantity, j));
    }
    check.predicted = band_of(values);
    checks.push_back(check);
  }
  return checks;
}

}  // namespace halocline::clients
