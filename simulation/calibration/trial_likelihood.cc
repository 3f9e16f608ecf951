// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/trial_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/elementary.h"
#include "simulation/calibration/delivery_curve.h"

namespace halocline::clients {
namespace {

constexpr int kPoints = 65;
constexpr double kWidest = 4;  // standard deviations
constexpr double kLeast = 1e-12;

struct SlowPoint {
  double at = 0, log_weight = 0;  // in standard deviations; logarithm of its share of the integral
};

const std::array<SlowPoint, kPoints>& slow_points() {
  static const std::array<SlowPoint, kPoints> points = [] {
    std::array<SlowPoint, kPoints> made;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double at = kWidest * (2.0 * i / (kPoints - 1) - 1);
      made[static_cast<std::size_t>(i)] = {at, -0.5 * at * at};
      sum += elementary::exp(-0.5 * at * at);
    }
    for (SlowPoint& point : made) point.log_weight -= elementary::log(sum);
    return made;
  }();
  return points;
}

// Likelihood of one pair's bins, which computes equal ones once.
class BinLikelihood {
 public:
  BinLikelihood(const ForecastPair& pair, const SeaNumbers& numbers)
      : pair_(pair),
        numbers_(numbers),
        slow_db_(elementary::exp(numbers[kLnSlowDb])),
        seas_(pair.forecasts.size()) {}

  double of(std::size_t bin_index) {
    const TrialBin& bin = pair_.trial.bins[bin_index];
    const std::size_t sea = pair_.forecast_of[bin_index];
    const PairForecast& forecast = pair_.forecasts[sea];
    double sum = 0;
    if (bin.sent > 0) sum += of_packets(sea, bin.sent, bin.received);
    if (bin.levels > 0)
      sum += of_level(bin.level_db - PairForecast::at(forecast.level_db, numbers_[kLnBottom]), bin.levels);
    if (bin.snrs > 0) {
      const double expected_db = PairForecast::at(forecast.snr_db, numbers_[kLnBottom]) - numbers_[kNoiseDb];
      sum += of_level(bin.snr_db - expected_db, bin.snrs);
    }
    return sum;
  }

 private:
  // Logarithms of the delivery and of its complement at the points of the slow term.
  struct Sea {
    bool is_made = false;
    std::array<double, kPoints> log_right{}, log_wrong{};
  };

  const Sea& sea_at(std::size_t index) {
    Sea& sea = seas_[index];
    if (sea.is_made) return sea;
    sea.is_made = true;
    const auto scores = pair_.forecasts[index].scores_at(numbers_[kLnBottom], numbers_[kLnEcho]);
    const double kept = pair_.times.kept_in_bins();
    const double of_bins_db = slow_db_ * std::sqrt(kept), within_db = slow_db_ * std::sqrt(1 - kept);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double more_db = numbers_[kNoiseDb] + numbers_[kReceiverDb] + of_bins_db * slow_points()[i].at;
      const double score = widened_score(scores, more_db, within_db);
      sea.log_right[i] = elementary::log(std::max(DeliveryCurve::delivery_of(score), kLeast));
      sea.log_wrong[i] = elementary::log(std::max(DeliveryCurve::delivery_of(-score), kLeast));
    }
    return sea;
  }

  double of_packets(std::size_t sea_index, std::int64_t sent, std::int64_t received) {
    const auto [at, is_new] = known_.try_emplace({sea_index, sent, received}, 0.0);
    if (!is_new) return at->second;
    const Sea& sea = sea_at(sea_index);
    const auto right = static_cast<double>(received), wrong = static_cast<double>(sent - received);
    std::array<double, kPoints> terms;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < kPoints; ++i) {
      terms[i] = slow_points()[i].log_weight + right * sea.log_right[i] + wrong * sea.log_wrong[i];
      most = std::max(most, terms[i]);
    }
    double sum = 0;
    for (const double term : terms) sum += elementary::exp(term - most);
    return at->second = most + elementary::log(sum);
  }

  double of_level(double error_db, std::size_t rows) const {
    const double variance = slow_db_ * slow_db_ + kLevelSpreadDb * kLevelSpreadDb / static_cast<double>(rows);
    return -0.5 * (error_db * error_db / variance + elementary::log(variance));
  }

  const ForecastPair& pair_;
  const SeaNumbers& numbers_;
  double slow_db_;
  std::vector<Sea> seas_;
  std::map<std::tuple<std::size_t, std::int64_t, std::int64_t>, double> known_;
};

}  // namespace

double SlowTimes::kept_in_bins() const {
  const auto kept = [this](double time_s) {
    const double u = bin_s / time_s;
    return 2 * (u + elementary::expm1(-u)) / (u * u);
  };
  return 0.5 * (kept(fading_s) + kept(noise_s));
}

double widened_score(const DeliveryCurve::Scores& scores, double more_noise_db, double spread_db) {
  const double step_db = DeliveryCurve::kStepDb;
  const double slope = (DeliveryCurve::score_at(scores, more_noise_db + step_db) -
                        DeliveryCurve::score_at(scores, more_noise_db - step_db)) /
                       (2 * step_db);
  const double spread = slope * spread_db;
  return DeliveryCurve::score_at(scores, more_noise_db) / std::sqrt(1 + spread * spread);
}

double log_likelihood(const ForecastPair& pair, const SeaNumbers& numbers) {
  BinLikelihood likelihood(pair, numbers);
  double sum = 0;
  for (std::size_t i = 0; i < pair.trial.bins.size(); ++i) sum += likelihood.of(i);
  return sum;
}

void add_by_window(const ForecastPair& pair, const SeaNumbers& numbers,
                   std::map<std::int64_t, double>& windows) {
  BinLikelihood likelihood(pair, numbers);
  for (std::size_t i = 0; i < pair.trial.bins.size(); ++i)
    windows[pair.trial.bins[i].window] += likelihood.of(i);
}

}  // namespace halocline::clients
