// SPDX-License-Identifier: BSD-3-Clause
// Confidence intervals of proportions and means.
//
// Proportions: Wilson's score interval (Wilson 1927, "Probable inference, the law of succession, and
// statistical inference") for k successes in n independent trials. It stays within 0 to 1 and holds for few
// trials (Newcombe 1998, method 3).
//
// Means: Student's t interval (1908), for independent values that are normal, or many.
//
// Means of proportions, such as one delivery ratio for each run: Wilson's interval with the effective number
// of trials that a proportion of the same variance would have (Korn and Graubard 1998, Survey Methodology 24,
// "Confidence intervals for proportions with small expected number of positive counts"; Dean and Pagano 2015,
// J. Surv. Stat. Methodol. 3), and Student's t instead of the normal quantile. It stays within 0 to 1, and
// approaches Student's interval where that is narrow and far from both ends.
//
// Quantiles are computed by Boost.Math.
#pragma once

#include <cstdint>
#include <span>

namespace halocline::clients {

struct ConfidenceInterval {
  double low = 0, high = 0;
};

// Returns the interval for k successes in n trials, 0 <= k <= n; both ends are NaN when n is 0. `level` is in
// (0, 1), such as 0.95.
ConfidenceInterval wilson_interval(std::int64_t k, std::int64_t n, double level);

struct MeanEstimate {
  double mean = 0;              // NaN without a value
  ConfidenceInterval interval;  // NaN with fewer than two values
};
// Returns the mean and its interval. NaNs among the values, from runs without such a number, are left out.
MeanEstimate mean_estimate(std::span<const double> values, double level);
// Returns the mean and its interval for proportions in 0..1. When all values are 0, or all are 1, each counts
// as one trial. Throws InvalidArgument for a value outside of 0..1.
MeanEstimate share_estimate(std::span<const double> values, double level);

}  // namespace halocline::clients
