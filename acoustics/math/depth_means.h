// SPDX-License-Identifier: BSD-3-Clause
// Means over depth of properties of the water that are smooth within cells of depth, without loss of digits
// between places however near to each other.
//
// Method: within a cell each property is the polynomial through its values at ten Chebyshev points (degree 9,
// ends included), kept as the powers of its integral P in x, -1 at the top of the cell and 1 at its bottom.
// The mean between two places of one cell is the quotient (P(b) - P(a)) / (b - a), which Horner's scheme
// divides without a difference; between places of two cells
//   mean = (mean to the bottom of the upper cell + whole cells between + mean from the top of the lower cell,
//   each times its
//           height) / (z2 - z1).
// Relative error: that of the polynomial (1e-12 of an exponential that triples across a cell), and 1e-15.
//
//   const DepthMeans water({0, 50, 12'000}, 1,
//                          [](double, std::span<double> values) { values[0] = 1 / 1500.0; });
//   const double slowness_s_per_m = water.mean(0, water.place(10), water.place(70));
//
// Immutable: calls may overlap between threads.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace halocline::acoustics {

class DepthMeans {
 public:
  static constexpr std::size_t kTerms = 10;  // of an integral: x^1..x^10
  // Sets `values` to the properties at a depth within the boundaries.
  using Sampler = std::function<void(double depth_m, std::span<double> values)>;

  // `boundaries_m` rising, at least two; `count` properties.
  DepthMeans(std::vector<double> boundaries_m, std::size_t count, const Sampler& sample);

  // A depth within the boundaries: its cell, and where it is there.
  struct Place {
    double depth_m;
    std::size_t cell;
    double x;  // -1..1
  };
  Place place(double depth_m) const;

  // The mean of a property between two places, `upper` not below `lower`; of one place, the property there.
  double mean(std::size_t property, const Place& upper, const Place& lower) const;

  std::size_t count() const { return count_; }
  double top_m(std::size_t cell) const { return boundaries_m_[cell]; }
  double bottom_m(std::size_t cell) const { return boundaries_m_[cell + 1]; }
  // [term * count() + property]: coefficients of P within a cell, from that of x^1 on.
  const double* terms(std::size_t cell) const { return terms_.data() + cell * kTerms * count_; }
  // [property]: integral from the first boundary to the top of a cell.
  const double* integral_to(std::size_t cell) const { return integrals_.data() + cell * count_; }

 private:
  void add_cell(const Sampler& sample);

  std::vector<double> boundaries_m_;
  std::size_t count_;
  std::vector<double> terms_, integrals_;
};

// (P(b) - P(a)) / (b - a) of P(x) = sum of terms[k * stride] x^(k + 1), -1 <= a <= b <= 1: in Horner's scheme
//   p = p a + c_k, q = q b + p
// p ends as P(a) and q as the quotient.
inline double mean_within_cell(const double* terms, std::size_t stride, double a, double b) {
  double value = terms[(DepthMeans::kTerms - 1) * stride], quotient = value;
  for (std::size_t k = DepthMeans::kTerms - 1; k-- > 0;) {
    value = value * a + terms[k * stride];
    quotient = quotient * b + value;
  }
  return quotient;
}

}  // namespace halocline::acoustics
