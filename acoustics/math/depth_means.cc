// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/depth_means.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using Terms = std::array<double, DepthMeans::kTerms>;

// Chebyshev points of the second kind, x_i = -cos(pi i / 9).
Terms chebyshev_points() {
  Terms points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = -elementary::cos(std::numbers::pi * static_cast<double>(i) / (DepthMeans::kTerms - 1));
  }
  return points;
}

// Coefficients of the powers of x of the polynomial through `values` at `points`: Newton's divided
// differences, multiplied out.
Terms powers_through(const Terms& points, Terms values) {
  for (std::size_t order = 1; order < points.size(); ++order) {
    for (std::size_t i = points.size(); i-- > order;) {
      values[i] = (values[i] - values[i - 1]) / (points[i] - points[i - order]);
    }
  }
  for (std::size_t k = points.size() - 1; k-- > 0;) {
    for (std::size_t i = k; i + 1 < points.size(); ++i) values[i] -= points[k] * values[i + 1];
  }
  return values;
}

}  // namespace

DepthMeans::DepthMeans(std::vector<double> boundaries_m, std::size_t count, const Sampler& sample)
    : boundaries_m_(std::move(boundaries_m)), count_(count), integrals_(count, 0) {
  require(boundaries_m_.size() >= 2, "depths need two boundaries");
  while (integrals_.size() < boundaries_m_.size() * count_) add_cell(sample);
}

void DepthMeans::add_cell(const Sampler& sample) {
  static const Terms kPoints = chebyshev_points();
  const std::size_t cell = integrals_.size() / count_ - 1;
  const double middle_m = (top_m(cell) + bottom_m(cell)) / 2, height_m = bottom_m(cell) - top_m(cell);
  std::array<std::vector<double>, kTerms> values;
  for (std::size_t i = 0; i < kTerms; ++i) {
    values[i].resize(count_);
    const double depth_m = middle_m + kPoints[i] * (height_m / 2);
    sample(std::clamp(depth_m, top_m(cell), bottom_m(cell)), values[i]);
  }
  terms_.resize(terms_.size() + kTerms * count_);
  double* terms = terms_.data() + cell * kTerms * count_;
  for (std::size_t property = 0; property < count_; ++property) {
    Terms of_property;
    for (std::size_t i = 0; i < kTerms; ++i) of_property[i] = values[i][property];
    of_property = powers_through(kPoints, of_property);
    // The integral of x^k is x^(k + 1) / (k + 1).
    for (std::size_t k = 0; k < kTerms; ++k)
      terms[k * count_ + property] = of_property[k] / static_cast<double>(k + 1);
  }
  for (std::size_t property = 0; property < count_; ++property) {
    integrals_.push_back(integrals_[cell * count_ + property] +
                         height_m * mean_within_cell(terms + property, count_, -1, 1));
  }
}

DepthMeans::Place DepthMeans::place(double depth_m) const {
  const auto below = std::upper_bound(boundaries_m_.begin() + 1, boundaries_m_.end() - 1, depth_m);
  const auto cell = static_cast<std::size_t>(below - boundaries_m_.begin() - 1);
  return {depth_m, cell, 2 * ((depth_m - top_m(cell)) / (bottom_m(cell) - top_m(cell))) - 1};
}

// mean = (head + whole cells between + tail) / (z2 - z1), with head and tail the integrals within the two
// cells.
double DepthMeans::mean(std::size_t property, const Place& upper, const Place& lower) const {
  const double *above = terms(upper.cell) + property, *below = terms(lower.cell) + property;
  if (upper.cell == lower.cell) return mean_within_cell(above, count_, upper.x, lower.x);
  const double head = (bottom_m(upper.cell) - upper.depth_m) * mean_within_cell(above, count_, upper.x, 1);
  const double tail = (lower.depth_m - top_m(lower.cell)) * mean_within_cell(below, count_, -1, lower.x);
  const double between = integral_to(lower.cell)[property] - integral_to(upper.cell + 1)[property];
  return (head + between + tail) / (lower.depth_m - upper.depth_m);
}

}  // namespace halocline::acoustics
