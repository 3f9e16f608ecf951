// SPDX-License-Identifier: BSD-3-Clause
// The Kaiser window, by which filters of infinite length are truncated (Kaiser and Schafer 1980).
#pragma once

namespace halocline::acoustics {

// w(x) = I0(beta sqrt(1 - x^2)) / I0(beta) for |x| <= 1, 0 beyond; beta 0..30. Outside of its passband a
// windowed filter is about 8.7 + 9.07 beta dB down.
double kaiser_window(double x, double beta);

}  // namespace halocline::acoustics
