// SPDX-License-Identifier: BSD-3-Clause
// Nodes and weights of integrals over a modem's band.
//
// Method: composite Gauss-Legendre quadrature with 16 nodes per panel unless stated otherwise. Noise,
// absorption and capacity are smooth in the logarithm of frequency, so panels have equal ratios of
// frequencies, at most kPanelRatio for any band. A single panel over a whole band errs by 5e-4 in capacity;
// these panels err by less than 1e-10 (measured in tests/acoustics/link/capacity_test.cc).
#pragma once

#include <vector>

#include "acoustics/math/gauss_legendre.h"

namespace halocline::acoustics {

// Greatest ratio of the highest to the lowest frequency of a panel.
inline constexpr double kPanelRatio = 1.08;

// A panel ends at this frequency, because the piecewise form of Thorp's absorption has a step there.
inline constexpr double kThorpJointHz = 400;

// A band of frequencies, Hz, 0 < low_hz < high_hz.
struct Band {
  double low_hz;
  double high_hz;
  double width_hz() const { return high_hz - low_hz; }
  double centre_hz() const { return (low_hz + high_hz) / 2; }
};

// The share, 0..1, of the band `of` that lies within `in`: of the power of sound spread evenly over `of`,
// this share lies in `in`.
double band_share(const Band& of, const Band& in);

// A node of the quadrature.
struct FrequencyNode {
  double frequency_hz;
  double weight_hz;  // the weights of a band sum to its width
};

// The nodes from `low_hz` to `high_hz`, 0 < low_hz <= high_hz, with rising frequency and the nodes of `rule`
// in each panel. A band of zero width has weights of 0.
std::vector<FrequencyNode> frequency_nodes(double low_hz, double high_hz, double panel_ratio = kPanelRatio,
                                           const GaussLegendreRule& rule = gauss_legendre_16());

}  // namespace halocline::acoustics
