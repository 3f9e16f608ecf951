// SPDX-License-Identifier: BSD-3-Clause
// Airy functions and their derivatives.
#pragma once

namespace halocline::acoustics {

// Ai, Bi and their derivatives at one argument.
struct Airy {
  double ai, bi, ai_slope, bi_slope;
};

// The Airy functions at `z` by the Maclaurin series (Abramowitz and Stegun 1964, 10.4.2), to 1e-11 of the
// larger function for |z| <= 5.
Airy airy(double z);

}  // namespace halocline::acoustics
