// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/turning_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/airy.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kFading = 2.5;  // x beyond which the differences to ray theory are faded out

// Differences of a wave field to ray theory. `share` holds the field's own values; from kFading on the
// differences fade out, with the phase tending to `far`.
// Ray theory has S = sqrt(x), 2 S' = 1 / sqrt(x) and theta = (2/3) x^(3/2). The differences fade out by
//   kept = 1 - 3 t^2 + 2 t^3,  t = (x - kFading) / (kSteepTurning - kFading).
TurningShare less_rays(double x, TurningShare share, double far) {
  if (x <= 0) return share;
  const double root = std::sqrt(x);
  share.sine -= root;
  share.phase -= 2.0 / 3 * x * root;
  if (x <= kFading) return share;
  const double width = kSteepTurning - kFading, t = (x - kFading) / width;
  const double kept = 1 - t * t * (3 - 2 * t), kept_slope = -6 * t * (1 - t) / width;
  return {share.sine * kept, 1 / root + (share.slope - 1 / root) * kept + 2 * share.sine * kept_slope,
          far + (share.phase - far) * kept};
}

}  // namespace

TurningShare turning_at_boundary(double x) {
  const Airy a = airy(-x);
  const double square = a.ai * a.ai + a.bi * a.bi;
  // S(x) = 1 / (pi M^2), 2 S'(x) and theta(x) = atan(Ai / Bi), with M^2 = Ai^2 + Bi^2 at -x.
  TurningShare share{1 / (pi * square), 4 / pi * (a.ai * a.ai_slope + a.bi * a.bi_slope) / (square * square),
                     elementary::atan2(a.ai, a.bi)};
  // theta lies between (2/3) x^(3/2) and pi / 4 above it.
  if (x > 0) {
    const double ray = 2.0 / 3 * x * std::sqrt(x);
    share.phase = ray + std::remainder(share.phase - ray, 2 * pi);
  }
  return less_rays(x, share, pi / 4);
}

TurningShare turning_at_knot(double x) {
  // Averages over the triangle: second differences of the functions whose second derivatives are
  //   (2/3) x^(3/2),  sqrt(x),  1 / sqrt(x).
  TurningShare share{0, 0, 0};
  const auto add = [&share](double at, double weight) {
    if (at <= 0) return;
    const double part = weight / (kKnotHalfWidth * kKnotHalfWidth) * at * std::sqrt(at);
    share.slope += 4.0 / 3 * part;
    share.sine += 4.0 / 15 * at * part;
    share.phase += 8.0 / 105 * at * at * part;
  };
  add(x + kKnotHalfWidth, 1);
  add(x, -2);
  add(x - kKnotHalfWidth, 1);
  return less_rays(x, share, 0);
}

double knot_widening(double change) {
  // The phase at x = 0 is 16 / 105 2^(3/2) = 0.431 times `change`, and it grows with the power 3/2 of the
  // width.
  constexpr double kMaxPhase = 0.05, kPhase = 0.431;  // rad
  const double widest = 10;
  return change > 0
             ? std::clamp(elementary::cbrt(elementary::pow(kMaxPhase / (kPhase * change), 2)), 1.0, widest)
             : 1;
}

// s0 = (2 g / omega)^(1/3) = (g / (pi f))^(1/3).
double turning_sine(double gradient_per_s, double frequency_hz) {
  return elementary::cbrt(gradient_per_s / (pi * frequency_hz));
}

}  // namespace halocline::acoustics
