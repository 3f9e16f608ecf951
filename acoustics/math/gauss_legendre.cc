// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/gauss_legendre.h"

#include <numbers>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

struct LegendreValue {
  double value, derivative;
};

// P_n and its derivative, by the three-term recurrence
//   k P_k = (2k - 1) x P_(k-1) - (k - 1) P_(k-2),  P_n' = n (x P_n - P_(n-1)) / (x^2 - 1)
LegendreValue legendre(int n, double x) {
  double before = 1, value = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
    before = value;
    value = next;
  }
  return {value, n * (x * value - before) / (x * x - 1)};
}

// The i-th root from above. Newton's method starts at Tricomi's estimate, which is close enough for it to
// converge:
//   x = cos(pi (i + 3/4) / (n + 1/2))
double legendre_root(int n, int i) {
  constexpr int kNewtonSteps = 12;  // quadratic convergence: 5 suffice for n = 64
  double x = elementary::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
  for (int step = 0; step < kNewtonSteps; ++step) {
    const LegendreValue p = legendre(n, x);
    x -= p.value / p.derivative;
  }
  return x;
}

}  // namespace

GaussLegendreRule make_gauss_legendre(int count) {
  require_in_range(count, 1, 64, "number of Gauss-Legendre nodes");
  GaussLegendreRule rule;
  for (int i = count - 1; i >= 0; --i) {
    const double x = legendre_root(count, i);
    // w = 2 / ((1 - x^2) P_n'(x)^2).
    const double slope = legendre(count, x).derivative;
    rule.nodes.push_back(x);
    rule.weights.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

const GaussLegendreRule& gauss_legendre_5() {
  static const GaussLegendreRule rule = make_gauss_legendre(5);
  return rule;
}

const GaussLegendreRule& gauss_legendre_16() {
  static const GaussLegendreRule rule = make_gauss_legendre(16);
  return rule;
}

}  // namespace halocline::acoustics
