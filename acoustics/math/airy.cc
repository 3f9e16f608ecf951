// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/airy.h"

#include <numbers>

namespace halocline::acoustics {

Airy airy(double z) {
  constexpr double kAi0 = 0.355028053887817239, kSlope0 = 0.258819403792806798;  // Ai(0), -Ai'(0)
  constexpr int kTerms = 22;
  // Ai = Ai(0) f + Ai'(0) g and Bi = sqrt(3) (Ai(0) f - Ai'(0) g), with f = sum of f_k z^(3k) and g = sum of
  // g_k z^(3k + 1). The derivative of a term is the term times (3k) / z and (3k + 1) / z.
  const double square = z * z, cube = z * square;
  double f = 1, g = z, f_slope = 0, g_slope = 1, f_term = 1, g_term = 1;  // g_term: without its factor z
  for (int k = 0; k < kTerms; ++k) {
    const double f_ratio = 1.0 / ((3 * k + 2) * (3 * k + 3)), g_ratio = 1.0 / ((3 * k + 3) * (3 * k + 4));
    f_slope += f_term * square * f_ratio * (3 * k + 3);
    f_term *= cube * f_ratio;
    g_term *= cube * g_ratio;
    f += f_term;
    g += z * g_term;
    g_slope += g_term * (3 * k + 4);
  }
  return {kAi0 * f - kSlope0 * g, std::numbers::sqrt3 * (kAi0 * f + kSlope0 * g),
          kAi0 * f_slope - kSlope0 * g_slope, std::numbers::sqrt3 * (kAi0 * f_slope + kSlope0 * g_slope)};
}

}  // namespace halocline::acoustics
