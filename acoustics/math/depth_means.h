// SPDX-License-Identifier: BSD-3-Clause
// Means over depth of properties of the water that are smooth within depth cells, without loss of precision
// between depths however close to each other.
//
// Method. Within a cell each property is the polynomial of degree 9 through its values at ten Chebyshev
// points, ends included. Stored are the coefficients of its integral P in x, which is -1 at the top of the
// cell and 1 at its bottom. The mean between two places of one cell is the quotient (P(b) - P(a)) / (b - a),
// which Horner's scheme evaluates without taking a difference. Between places of two cells,
//   mean = (h1 m1 + whole cells between + h2 m2) / (z2 - z1),
// with h1 m1 the height times the mean from the upper place to the bottom of its cell, and h2 m2 the same
// from the top of the lower cell to the lower place. Relative error: that of the polynomial (1e-12 for an
// exponential that triples across a cell), and 1e-15.
//
//   const DepthMeans water({0, 50, 12'000}, 1,
//                          [](double, std::span<double> values) { values[0] = 1 / 1500.0; });
//   const double slowness_s_per_m = water.mean(0, water.place(10), water.place(70));
//
// Thread rule: immutable; threads may call at the same time.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace halocline::acoustics {

// Means over depth of a set of properties.
class DepthMeans {
 public:
  static constexpr std::size_t kTerms = 10;  // coefficients of an integral: x^1..x^10
  // Sets `values` to the properties at a depth within the boundaries.
  using Sampler = std::function<void(double depth_m, std::span<double> values)>;

  // `boundaries_m` are the rising boundaries of the cells, at least two; `count` is the number of properties.
  DepthMeans(std::vector<double> boundaries_m, std::size_t count, const Sampler& sample);

  // A depth within the boundaries: its cell, and its coordinate within the cell.
  struct Place {
    double depth_m;
    std::size_t cell;
    double x;  // -1..1
  };
  Place place(double depth_m) const;

  // The mean of a property between two places, `upper` not below `lower`; when both are one place, the
  // property there.
  double mean(std::size_t property, const Place& upper, const Place& lower) const;

  std::size_t count() const { return count_; }
  double top_m(std::size_t cell) const { return boundaries_m_[cell]; }
  double bottom_m(std::size_t cell) const { return boundaries_m_[cell + 1]; }
  // Coefficients of P within a cell, from that of x^1 on: [term * count() + property].
  const double* terms(std::size_t cell) const { return terms_.data() + cell * kTerms * count_; }
  // Integrals from the first boundary to the top of a cell: [property].
  const double* integral_to(std::size_t cell) const { return integrals_.data() + cell * count_; }

 private:
  void add_cell(const Sampler& sample);

  std::vector<double> boundaries_m_;
  std::size_t count_;
  std::vector<double> terms_, integrals_;
};

// The quotient (P(b) - P(a)) / (b - a) of P(x) = sum of terms[k * stride] x^(k + 1), for -1 <= a <= b <= 1.
// In Horner's scheme
//   p = p a + c_k,  q = q b + p
// p ends as P(a) / a and q as the quotient.
inline double mean_within_cell(const double* terms, std::size_t stride, double a, double b) {
  double value = terms[(DepthMeans::kTerms - 1) * stride], quotient = value;
  for (std::size_t k = DepthMeans::kTerms - 1; k-- > 0;) {
    value = value * a + terms[k * stride];
    quotient = quotient * b + value;
  }
  return quotient;
}

}  // namespace halocline::acoustics
