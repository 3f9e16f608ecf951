// SPDX-License-Identifier: BSD-3-Clause
// Fit of a scenario's numbers to the pairs of a trial: the maximum of prior times likelihood, and errors from
// its curvature.
//
// Bins that are near in time share the slow sea, so they tell less than the likelihood of independent bins.
// The scores of all pairs in each bin of time are summed, and their variance is taken with the neighbours up
// to 12 h apart (Newey and West 1987, Econometrica 55, 703); the information of each number is divided by how
// much larger that is than its curvature, at least by 1.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "simulation/calibration/trial_likelihood.h"

namespace halocline::clients {

// Normal distribution of a number before the trial.
struct SeaPrior {
  double mean = 0, deviation = 1;
};
using SeaPriors = std::array<SeaPrior, kSeaNumbers>;

// Normal distribution of some numbers; the others are held.
struct SeaPosterior {
  std::vector<SeaNumber> fitted;
  SeaNumbers numbers{};        // most likely ones
  Eigen::MatrixXd covariance;  // of the fitted ones, in their order

  // Returns the index of a number among the fitted ones; its size when it is none of them.
  std::size_t index_of(SeaNumber number) const;
  double deviation(std::size_t index) const;
  double correlation(std::size_t one, std::size_t other) const;
};

class TrialFit {
 public:
  static constexpr std::size_t kNoPair = std::numeric_limits<std::size_t>::max();

  // `pairs` must outlive the fit. `windows_joined` is the number of following bins of time that share the
  // slow sea.
  TrialFit(const std::vector<ForecastPair>& pairs, const SeaPriors& priors, int windows_joined)
      : pairs_(pairs), priors_(priors), windows_joined_(windows_joined) {}

  const SeaPriors& priors() const { return priors_; }
  // Fits these numbers from the means of the priors, which the others keep.
  SeaPosterior fit(const std::vector<SeaNumber>& fitted) const;
  // Fits the numbers of a posterior again without one pair, near it.
  SeaPosterior fit_without(const SeaPosterior& all, std::size_t left_out) const;

 private:
  SeaNumbers numbers_at(const SeaPosterior& posterior, const Eigen::VectorXd& values) const;
  double minus_log_likelihood(const SeaPosterior& posterior, const Eigen::VectorXd& values,
                              std::size_t left_out) const;
  double minus_log_prior(const SeaPosterior& posterior, const Eigen::VectorXd& values) const;
  Eigen::VectorXd prior_deviations(const SeaPosterior& posterior) const;
  Eigen::VectorXd values_of(const SeaPosterior& posterior) const;
  // Returns by how much the variance of each score exceeds its curvature, at least 1.
  Eigen::VectorXd excess(const SeaPosterior& posterior, const Eigen::MatrixXd& information) const;
  void set_covariance(SeaPosterior& posterior, std::size_t left_out) const;

  const std::vector<ForecastPair>& pairs_;
  SeaPriors priors_;
  int windows_joined_;
};

}  // namespace halocline::clients
