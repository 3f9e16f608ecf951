// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/trial_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include <Eigen/Dense>

#include "simulation/calibration/minimum.h"

namespace halocline::clients {
namespace {

constexpr int kValuesANumber = 150;       // evaluations of a first search, for each number
constexpr int kValuesANumberAgain = 40;   // without one pair
constexpr double kFirstStep = 0.5;        // in deviations of the prior
constexpr double kDifferenceStep = 0.05;  // likewise
constexpr double kMostExcess = 100;

}  // namespace

std::size_t SeaPosterior::index_of(SeaNumber number) const {
  return static_cast<std::size_t>(std::find(fitted.begin(), fitted.end(), number) - fitted.begin());
}

double SeaPosterior::deviation(std::size_t index) const {
  const auto i = static_cast<Eigen::Index>(index);
  return std::sqrt(covariance(i, i));
}

double SeaPosterior::correlation(std::size_t one, std::size_t other) const {
  return covariance(static_cast<Eigen::Index>(one), static_cast<Eigen::Index>(other)) /
         (deviation(one) * deviation(other));
}

SeaNumbers TrialFit::numbers_at(const SeaPosterior& posterior, const Eigen::VectorXd& values) const {
  SeaNumbers numbers = posterior.numbers;
  for (std::size_t i = 0; i < posterior.fitted.size(); ++i)
    numbers[posterior.fitted[i]] = values[static_cast<Eigen::Index>(i)];
  return numbers;
}

double TrialFit::minus_log_likelihood(const SeaPosterior& posterior, const Eigen::VectorXd& values,
                                      std::size_t left_out) const {
  const SeaNumbers numbers = numbers_at(posterior, values);
  double sum = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (p != left_out) sum -= log_likelihood(pairs_[p], numbers);
  return sum;
}

double TrialFit::minus_log_prior(const SeaPosterior& posterior, const Eigen::VectorXd& values) const {
  double sum = 0;
  for (std::size_t i = 0; i < posterior.fitted.size(); ++i) {
    const SeaPrior& prior = priors_[posterior.fitted[i]];
    const double z = (values[static_cast<Eigen::Index>(i)] - prior.mean) / prior.deviation;
    sum += 0.5 * z * z;
  }
  return sum;
}

Eigen::VectorXd TrialFit::prior_deviations(const SeaPosterior& posterior) const {
  Eigen::VectorXd deviations(static_cast<Eigen::Index>(posterior.fitted.size()));
  for (std::size_t i = 0; i < posterior.fitted.size(); ++i)
    deviations[static_cast<Eigen::Index>(i)] = priors_[posterior.fitted[i]].deviation;
  return deviations;
}

Eigen::VectorXd TrialFit::values_of(const SeaPosterior& posterior) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(posterior.fitted.size()));
  for (std::size_t i = 0; i < posterior.fitted.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = posterior.numbers[posterior.fitted[i]];
  return values;
}

Eigen::VectorXd TrialFit::excess(const SeaPosterior& posterior, const Eigen::MatrixXd& information) const {
  const Eigen::VectorXd steps = kDifferenceStep * prior_deviations(posterior), at = values_of(posterior);
  Eigen::VectorXd excess = Eigen::VectorXd::Ones(at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    std::map<std::int64_t, double> above, scores;
    Eigen::VectorXd place = at;
    place[i] += steps[i];
    for (const ForecastPair& pair : pairs_) add_by_window(pair, numbers_at(posterior, place), above);
    place[i] = at[i] - steps[i];
    for (const ForecastPair& pair : pairs_) add_by_window(pair, numbers_at(posterior, place), scores);
    for (auto& [window, score] : scores) score = (above[window] - score) / (2 * steps[i]);
    const int joined = std::min(windows_joined_, static_cast<int>(scores.size() / 2));
    double variance = 0;
    for (const auto& [window, score] : scores) {
      variance += score * score;
      for (int lag = 1; lag <= joined; ++lag) {
        const auto later = scores.find(window + lag);
        if (later != scores.end()) variance += 2 * (1 - lag / (joined + 1.0)) * score * later->second;
      }
    }
    if (information(i, i) > 0) excess[i] = std::clamp(variance / information(i, i), 1.0, kMostExcess);
  }
  return excess;
}

void TrialFit::set_covariance(SeaPosterior& posterior, std::size_t left_out) const {
  const Eigen::VectorXd deviations = prior_deviations(posterior);
  const Eigen::MatrixXd measured = curvature_of(
      [&](const Eigen::VectorXd& values) { return minus_log_likelihood(posterior, values, left_out); },
      values_of(posterior), kDifferenceStep * deviations);
  // Rounding and flat directions leave small negative curvatures, which tell nothing.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(measured);
  const Eigen::MatrixXd information =
      parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).asDiagonal() * parts.eigenvectors().transpose();
  const Eigen::VectorXd weights = excess(posterior, information).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd prior = deviations.cwiseAbs2().cwiseInverse().asDiagonal();
  posterior.covariance = (weights.asDiagonal() * information * weights.asDiagonal() + prior).inverse();
}

SeaPosterior TrialFit::fit(const std::vector<SeaNumber>& fitted) const {
  SeaPosterior posterior{.fitted = fitted, .numbers = {}, .covariance = {}};
  for (std::size_t i = 0; i < kSeaNumbers; ++i) posterior.numbers[i] = priors_[i].mean;
  if (fitted.empty()) return posterior;
  const auto target = [&](const Eigen::VectorXd& values) {
    return minus_log_likelihood(posterior, values, kNoPair) + minus_log_prior(posterior, values);
  };
  const Eigen::VectorXd steps = kFirstStep * prior_deviations(posterior);
  const int most = kValuesANumber * static_cast<int>(fitted.size());
  // A simplex may shrink before it arrives: a second one starts where the first ended.
  const Eigen::VectorXd first = minimum_of(target, values_of(posterior), steps, most);
  posterior.numbers = numbers_at(posterior, minimum_of(target, first, -0.4 * steps, most));
  set_covariance(posterior, kNoPair);
  return posterior;
}

SeaPosterior TrialFit::fit_without(const SeaPosterior& all, std::size_t left_out) const {
  SeaPosterior posterior = all;
  if (all.fitted.empty()) return posterior;
  const auto target = [&](const Eigen::VectorXd& values) {
    return minus_log_likelihood(posterior, values, left_out) + minus_log_prior(posterior, values);
  };
  Eigen::VectorXd steps(static_cast<Eigen::Index>(all.fitted.size()));
  for (std::size_t i = 0; i < all.fitted.size(); ++i) steps[static_cast<Eigen::Index>(i)] = all.deviation(i);
  const int most = kValuesANumberAgain * static_cast<int>(all.fitted.size());
  posterior.numbers = numbers_at(posterior, minimum_of(target, values_of(posterior), steps, most));
  set_covariance(posterior, left_out);
  return posterior;
}

}  // namespace halocline::clients
