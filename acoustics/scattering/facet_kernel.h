// SPDX-License-Identifier: BSD-3-Clause
// Law of facets: how one bounce at a rough boundary spreads the scattered power over grazing angles.
//
// Model (Kirchhoff's approximation in its geometric limit). Facets of slope a, normally distributed with the
// variance s2 in the plane of the sound, reflect like mirrors. From angle i to angle j leads the slope
//   a = tan((theta_j - theta_i) / 2),
// met by sin((theta_i + theta_j) / 2):
//   sigma_ij = exp(-a^2 / (2 s2)) / sqrt(2 pi s2) / 2 sin((theta_i + theta_j) / 2) / cos^2((theta_j -
//   theta_i) / 2) K_ij = d_i sigma_ij w_j d_j / sin(theta_i)
// with w_j the width of bin j at the boundary and factors d > 0 that make row i sum to the scattered share.
// They do what shadowing functions do; energy and reciprocity hold to rounding whatever the slopes are
// (balancing in the place of a shadowing formula is our choice).
//
// Validity: Rayleigh parameter above 1; below, little is scattered. Left out: backscatter, slopes across the
// plane.
#pragma once

#include <cstddef>
#include <vector>

namespace halocline::acoustics {

// Bins of grazing angle at one boundary.
struct FacetBins {
  std::vector<double> angle_rad;  // middles, (0, pi/2)
  std::vector<double> width_rad;  // w, above 0
  std::vector<double> scattered;  // share of the power that a bounce scatters, 0..1
};

// K without its loss, as the symmetric part d_i sigma_ij d_j, n x n and row-major:
//   K_ij = part_ij w_j / sin(theta_i).
struct FacetKernel {
  std::size_t size = 0;
  std::vector<double> part;
};

// The kernel for facets of that variance of slope, above 0. Throws InvalidArgument when the bins differ in
// number.
FacetKernel facet_kernel(const FacetBins& bins, double slope_variance);

}  // namespace halocline::acoustics
