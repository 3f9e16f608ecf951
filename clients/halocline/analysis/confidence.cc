// SPDX-License-Identifier: BSD-3-Clause
#include "clients/halocline/analysis/confidence.h"

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

// In doubles throughout: tables that Boost fills at start-up in long doubles overflow under valgrind, which has none.
using Doubles = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Normal = boost::math::normal_distribution<double, Doubles>;
using StudentsT = boost::math::students_t_distribution<double, Doubles>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void require_level(double level) {
  require(level > 0 && level < 1, "the level of confidence must lie between 0 and 1");
}

}  // namespace

ConfidenceInterval wilson_interval(std::int64_t k, std::int64_t n, double level) {
  require_level(level);
  require(k >= 0 && k <= n, "a share is k of n trials, 0 <= k <= n");
  if (n == 0) return {kNaN, kNaN};
  const double z = boost::math::quantile(Normal(), 0.5 + level / 2), trials = static_cast<double>(n);
  const double share = static_cast<double>(k) / trials, z2 = z * z / trials;
  const double middle = (share + z2 / 2) / (1 + z2);
  const double half = z * std::sqrt(share * (1 - share) / trials + z2 / (4 * trials)) / (1 + z2);
  // At the ends the closed form is 0 or 1 but for rounding.
  return {k == 0 ? 0 : std::max(0.0, middle - half), k == n ? 1 : std::min(1.0, middle + half)};
}

MeanEstimate mean_estimate(std::span<const double> values, double level) {
  require_level(level);
  std::vector<double> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known),
               [](double v) { return !std::isnan(v); });
  const auto n = static_cast<double>(known.size());
  if (known.empty()) return {kNaN, {kNaN, kNaN}};
  double sum = 0, squares = 0;
  for (const double v : known) sum += v;
  const double mean = sum / n;
  if (known.size() < 2) return {mean, {kNaN, kNaN}};
  for (const double v : known) squares += (v - mean) * (v - mean);
  const double t = boost::math::quantile(StudentsT(n - 1), 0.5 + level / 2);
  const double half = t * std::sqrt(squares / (n - 1) / n);
  return {mean, {mean - half, mean + half}};
}

}  // namespace halocline::clients
