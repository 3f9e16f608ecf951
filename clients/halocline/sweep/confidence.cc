#include "clients/halocline/sweep/confidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/check.h"

namespace halocline::clients {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double normal_below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// The continued fraction of the incomplete beta function by Lentz' method; converges fast for x < (a+1)/(a+b+2).
double beta_fraction(double a, double b, double x) {
  constexpr int kMaxTerms = 500;
  constexpr double kTiny = 1e-300, kEnough = 1e-15;
  double c = 1, d = 1 / std::max(1 - (a + b) * x / (a + 1), kTiny), sum = d;
  for (int m = 1; m <= kMaxTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    for (const double term : {even, odd}) {
      d = 1 + term * d;
      c = 1 + term / c;
      if (std::abs(d) < kTiny) d = kTiny;
      if (std::abs(c) < kTiny) c = kTiny;
      d = 1 / d;
      sum *= c * d;
    }
    if (std::abs(c * d - 1) < kEnough) break;
  }
  return sum;
}

// I_x(a, b), regularised.
double incomplete_beta(double a, double b, double x) {
  if (x <= 0 || x >= 1) return x <= 0 ? 0 : 1;
  const double log_front =
      std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
  const double front = std::exp(log_front);
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

double student_below(double t, double degrees) {
  const double tail = 0.5 * incomplete_beta(degrees / 2, 0.5, degrees / (degrees + t * t));
  return t > 0 ? 1 - tail : tail;
}

// The root of a rising function that is p there, for p >= 0.5.
template <class Function>
double solve(const Function& below, double p) {
  double low = 0, high = 1;
  while (below(high) < p && high < 1e12) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
    const double middle = (low + high) / 2;
    (below(middle) < p ? low : high) = middle;
  }
  return (low + high) / 2;
}

void require_level(double level) {
  require(level > 0 && level < 1, "the level of confidence must lie between 0 and 1");
}

}  // namespace

double normal_quantile(double p) {
  require(p > 0 && p < 1, "a probability must lie between 0 and 1");
  return p < 0.5 ? -normal_quantile(1 - p) : solve(normal_below, p);
}

double student_quantile(double p, double degrees) {
  require(p > 0 && p < 1 && degrees >= 1, "a probability between 0 and 1 and a degree of freedom are needed");
  if (p < 0.5) return -student_quantile(1 - p, degrees);
  return solve([&](double t) { return student_below(t, degrees); }, p);
}

ConfidenceInterval wilson_interval(std::int64_t k, std::int64_t n, double level) {
  require_level(level);
  require(k >= 0 && k <= n, "a share is k of n trials, 0 <= k <= n");
  if (n == 0) return {kNaN, kNaN};
  const double z = normal_quantile(0.5 + level / 2), trials = static_cast<double>(n);
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
  const double half = student_quantile(0.5 + level / 2, n - 1) * std::sqrt(squares / (n - 1) / n);
  return {mean, {mean - half, mean + half}};
}

}  // namespace halocline::clients
