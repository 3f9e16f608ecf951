// SPDX-License-Identifier: BSD-3-Clause
// Tolerances of the tests: one environment variable tightens them all.
#pragma once

#include <cmath>
#include <cstdlib>

namespace halocline::testing {

// `stated` times HALOCLINE_TOLERANCE_SCALE (0 < scale <= 1, default 1): setting it to 0.5 shows which tests
// pass only just. It can never loosen a bound.
inline double tolerance(double stated) {
  const char* text = std::getenv("HALOCLINE_TOLERANCE_SCALE");
  const double scale = text != nullptr ? std::atof(text) : 1.0;
  return stated * (scale > 0 && scale <= 1 ? scale : 1.0);
}

// |actual - expected| relative to |expected|; the absolute difference where expected is 0.
inline double relative_error(double actual, double expected) {
  return std::abs(actual - expected) / (expected != 0 ? std::abs(expected) : 1.0);
}

}  // namespace halocline::testing
