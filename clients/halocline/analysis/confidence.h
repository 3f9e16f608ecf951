// SPDX-License-Identifier: BSD-3-Clause
// Confidence intervals of shares and means.
//
// Shares: Wilson's score interval (Wilson 1927, "Probable inference, the law of succession, and statistical
// inference"), for k of n independent trials; it stays within 0 to 1 and holds for few trials (Newcombe 1998,
// method 3). Means: Student's t (1908), for independent values that are normal, or many. Means of shares, as
// of one delivery ratio a run: Wilson's interval with the number of trials that a share of the same variance
// would have (Korn and Graubard 1998, Survey Methodology 24, "Confidence intervals for proportions with small
// expected number of positive counts"; Dean and Pagano 2015, J. Surv. Stat. Methodol. 3), and Student's t in
// the place of the normal quantile. It lies within 0 to 1, and is Student's interval where that is narrow and
// far from both. Quantiles by Boost.Math.
#pragma once

#include <cstdint>
#include <span>

namespace halocline::clients {

struct ConfidenceInterval {
  double low = 0, high = 0;
};

// k of n trials, 0 <= k <= n; NaN both where n is 0. `level` in (0, 1), such as 0.95.
ConfidenceInterval wilson_interval(std::int64_t k, std::int64_t n, double level);

struct MeanEstimate {
  double mean = 0;              // NaN without a value
  ConfidenceInterval interval;  // NaN with fewer than two values
};
// NaNs among the values are left out: a run that has no such number.
MeanEstimate mean_estimate(std::span<const double> values, double level);
// Likewise of values in 0..1. Values that all are 0, or all 1, count as one trial each.
MeanEstimate share_estimate(std::span<const double> values, double level);

}  // namespace halocline::clients
