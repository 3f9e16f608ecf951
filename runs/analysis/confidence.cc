// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/confidence.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/policies/policy.hpp>

#include "core/check.h"

namespace halocline::clients {
namespace {

// Computations are in double precision: tables that Boost fills at start-up in long double overflow under
// valgrind, which does not support that type.
using Doubles = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Normal = boost::math::normal_distribution<double, Doubles>;
using StudentsT = boost::math::students_t_distribution<double, Doubles>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void require_level(double level) {
  require(level > 0 && level < 1, "the level of confidence must lie between 0 and 1");
}

// Wilson's score interval (Wilson 1927) for a proportion p in n trials, `quantile` z being normal or
// Student's t:
//   ( p + z^2 / (2 n) +- z sqrt(p (1 - p) / n + z^2 / (4 n^2)) ) / (1 + z^2 / n)
// The end at a proportion of 0 or 1 is set to 0 or 1 exactly, which the formula gives except for rounding.
ConfidenceInterval score_interval(double share, double trials, double quantile) {
  const double q2 = quantile * quantile / trials, middle = (share + q2 / 2) / (1 + q2);
  const double half = quantile * std::sqrt(share * (1 - share) / trials + q2 / (4 * trials)) / (1 + q2);
  return {share == 0 ? 0 : std::max(0.0, middle - half), share == 1 ? 1 : std::min(1.0, middle + half)};
}

// Values without the NaNs, with their sample mean and variance.
struct Sample {
  explicit Sample(std::span<const double> values) {
    std::copy_if(values.begin(), values.end(), std::back_inserter(known),
                 [](double v) { return !std::isnan(v); });
    count = static_cast<double>(known.size());
    for (const double v : known) mean += v / count;
    for (const double v : known) variance += (v - mean) * (v - mean) / (count - 1);
  }
  double t(double level) const { return boost::math::quantile(StudentsT(count - 1), 0.5 + level / 2); }

  std::vector<double> known;
  double count = 0, mean = 0, variance = 0;
};

}  // namespace

ConfidenceInterval wilson_interval(std::int64_t k, std::int64_t n, double level) {
  require_level(level);
  require(k >= 0 && k <= n, "a share is k of n trials, 0 <= k <= n");
  if (n == 0) return {kNaN, kNaN};
  const double z = boost::math::quantile(Normal(), 0.5 + level / 2), trials = static_cast<double>(n);
  return score_interval(static_cast<double>(k) / trials, trials, z);
}

MeanEstimate mean_estimate(std::span<const double> values, double level) {
  require_level(level);
  const Sample sample(values);
  if (sample.known.empty()) return {kNaN, {kNaN, kNaN}};
  if (sample.known.size() < 2) return {sample.mean, {kNaN, kNaN}};
  const double half = sample.t(level) * std::sqrt(sample.variance / sample.count);
  return {sample.mean, {sample.mean - half, sample.mean + half}};
}

MeanEstimate share_estimate(std::span<const double> values, double level) {
  require(std::none_of(values.begin(), values.end(), [](double v) { return v < 0 || v > 1; }),
          "shares lie within 0 to 1");
  MeanEstimate estimate = mean_estimate(values, level);
  const Sample sample(values);
  if (sample.known.size() < 2) return estimate;
  const double p = std::clamp(sample.mean, 0.0, 1.0);
  if (p > 0 && p < 1 && sample.variance == 0) return estimate;  // the interval has no width
  // Effective number of trials n of m values with mean p and variance s^2, from p (1 - p) / n = s^2 / m.
  const double trials = p > 0 && p < 1 ? p * (1 - p) * sample.count / sample.variance : sample.count;
  estimate.interval = score_interval(p, trials, sample.t(level));
  return estimate;
}

}  // namespace halocline::clients
