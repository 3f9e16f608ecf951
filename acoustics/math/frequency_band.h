// SPDX-License-Identifier: BSD-3-Clause
// The frequencies at which integrals over a modem's band are taken.
//
// Method: composite Gauss-Legendre, 16 nodes a panel unless stated. Noise, absorption and capacity are smooth
// in the logarithm of frequency, so panels are equal there: each spans at most a ratio of kPanelRatio,
// whatever the band. One panel over a whole band errs by 5e-4 in capacity; these err by less than 1e-10
// (tests/acoustics/link/capacity_test.cc measures it).
#pragma once

#include <vector>

#include "acoustics/math/gauss_legendre.h"

namespace halocline::acoustics {

inline constexpr double kPanelRatio = 1.08;  // highest over lowest frequency of one panel, at most

// Panels end here: the piecewise form of Thorp's absorption steps at this frequency.
inline constexpr double kThorpJointHz = 400;

// A band of frequencies, Hz, 0 < low_hz < high_hz.
struct Band {
  double low_hz;
  double high_hz;
  double width_hz() const { return high_hz - low_hz; }
  double centre_hz() const { return (low_hz + high_hz) / 2; }
};

// The share of `of` that lies within `in`, 0..1: of sound spread evenly over the one band, that much of its
// power lies in the other.
double band_share(const Band& of, const Band& in);

struct FrequencyNode {
  double frequency_hz;
  double weight_hz;  // the weights of a band sum to its width
};

// Nodes from `low_hz` to `high_hz`, 0 < low_hz <= high_hz; rising frequency, those of `rule` in each panel. A
// band of no width has weights of 0.
std::vector<FrequencyNode> frequency_nodes(double low_hz, double high_hz, double panel_ratio = kPanelRatio,
                                           const GaussLegendreRule& rule = gauss_legendre_16());

}  // namespace halocline::acoustics
