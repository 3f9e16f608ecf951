// SPDX-License-Identifier: BSD-3-Clause
// Gauss-Legendre quadrature: integrals of smooth functions over an interval.
//
// Model: the nodes are the roots of the Legendre polynomial P_n and the weights are 2 / ((1 - x^2) P_n'(x)^2)
// (Abramowitz and Stegun 1964, 25.4.29). The rule is exact for polynomials up to degree 2n - 1. Newton's
// method gives the nodes to the last bit. The integrand has to be smooth inside the interval; split the
// interval at a kink.
//
//   const double area = integrate(gauss_legendre_5(), 0.0, 1.0, [](double x) { return x * x; });  // 1/3
//
// Thread rule: values only; threads may call at the same time.
#pragma once

#include <vector>

namespace halocline::acoustics {

// Nodes and weights on [-1, 1]; both have the same size, at least 1.
struct GaussLegendreRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};

// The rule of `count` nodes, 1 to 64; throws InvalidArgument for other counts.
GaussLegendreRule make_gauss_legendre(int count);

// The two rules that the models use, computed once: 5 nodes over a layer of water, 16 over a panel of
// frequencies.
const GaussLegendreRule& gauss_legendre_5();
const GaussLegendreRule& gauss_legendre_16();

// The integral of function(x) dx from `from` to `to` in one panel; `from` may exceed `to`.
template <typename Function>
double integrate(const GaussLegendreRule& rule, double from, double to, const Function& function) {
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    sum += rule.weights[i] * function(middle + half * rule.nodes[i]);
  }
  return sum * half;
}

}  // namespace halocline::acoustics
