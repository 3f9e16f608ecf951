// SPDX-License-Identifier: BSD-3-Clause
// Airy's functions and their slopes.
#pragma once

namespace halocline::acoustics {

struct Airy {
  double ai, bi, ai_slope, bi_slope;
};

// By the series of Maclaurin (Abramowitz and Stegun 1964, 10.4.2), to 1e-11 of the larger function for |z| <=
// 5.
Airy airy(double z);

}  // namespace halocline::acoustics
