// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/scattering/facet_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kBalanced = 1e-13;  // greatest relative change of a factor in the last round
constexpr int kMaxRounds = 4000;     // 46 suffice, up to a thousand with a smooth boundary
constexpr double kLeastTarget = 1e-30;

// sigma of all pairs. With t = tan(theta / 2) of both angles, a = (t_j - t_i) / (1 + t_i t_j); and
// 1 / cos^2((theta_j - theta_i) / 2) = 1 + a^2.
std::vector<double> cross_sections(const std::vector<double>& angles, double s2) {
  const std::size_t n = angles.size();
  std::vector<double> sine(n), cosine(n), sigma(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    sine[i] = elementary::sin(angles[i] / 2);
    cosine[i] = elementary::cos(angles[i] / 2);
  }
  const double scale = 0.5 / std::sqrt(2 * std::numbers::pi * s2), width = -0.5 / s2;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double across = sine[i] * cosine[j] - cosine[i] * sine[j];
      const double along = cosine[i] * cosine[j] + sine[i] * sine[j];
      const double a2 = across * across / (along * along);
      const double met = sine[i] * cosine[j] + cosine[i] * sine[j];
      sigma[i * n + j] = sigma[j * n + i] = scale * elementary::exp(width * a2) * met * (1 + a2);
    }
  }
  return sigma;
}

// sums_i = sum over j of sigma_ij x_j, by rows of the symmetric matrix.
void multiply(const std::vector<double>& sigma, const std::vector<double>& x, std::vector<double>& sums) {
  const std::size_t n = x.size();
  std::fill(sums.begin(), sums.end(), 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    const double* row = &sigma[j * n];
    for (std::size_t i = 0; i < n; ++i) sums[i] += row[i] * x[j];
  }
}

}  // namespace

FacetKernel facet_kernel(const FacetBins& bins, double slope_variance) {
  const std::size_t n = bins.angle_rad.size();
  require(bins.width_rad.size() == n && bins.scattered.size() == n && slope_variance > 0,
          "facets need a width and a scattered share for each angle, and slopes");
  FacetKernel kernel{n, cross_sections(bins.angle_rad, slope_variance)};
  std::vector<double> target(n), d(n), weighted(n), sums(n);
  for (std::size_t i = 0; i < n; ++i) {
    target[i] = std::max(elementary::sin(bins.angle_rad[i]) * bins.scattered[i], kLeastTarget);
    d[i] = std::sqrt(target[i]);
  }
  // d_i <- sqrt(d_i target_i / sum_j sigma_ij w_j d_j)
  for (int round = 0; round < kMaxRounds; ++round) {
    for (std::size_t i = 0; i < n; ++i) weighted[i] = bins.width_rad[i] * d[i];
    multiply(kernel.part, weighted, sums);
    double changed = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double next = std::sqrt(d[i] * target[i] / sums[i]);
      changed = std::max(changed, std::abs(next / d[i] - 1));
      d[i] = next;
    }
    if (changed < kBalanced) break;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) kernel.part[i * n + j] *= d[i] * d[j];
  }
  return kernel;
}

}  // namespace halocline::acoustics
