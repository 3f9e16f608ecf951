// SPDX-License-Identifier: BSD-3-Clause
// The field of rays that turn back close to a boundary, or close to a knot at which the gradient of the speed
// changes.
//
// Model. With s the sine of a ray's angle at the boundary or knot, s^2 < 0 for a ray that turns before it,
// rays gather the range D s / xi and the phase omega D s^3 / 3 there, D the change of 1 / gradient; both
// begin with a kink where s = 0, so amplitudes jump between 0, infinity and that of the ray that turns. The
// field of a wave is smooth on the scale
//   s0 = (2 g / omega)^(1/3),  x = s^2 / s0^2:
// where the speed is linear in depth it is Airy's function, of length c s0^2 / (2 g). Before a boundary at
// which pressure is 0 (the surface, or the bottom at grazing) it is one of Ai and Bi that vanishes there, and
// the reflected wave has, against one that turns, the phase 2 theta(x), theta = atan(Ai(-x) / Bi(-x)): from 0
// deep below to (4/3) x^(3/2) + pi / 2, that of a ray that is reflected (Brekhovskikh and Godin 1999, chapter
// 3; Murphy and Davis 1974, JASA 56, 1747: rays of modified range). Its slope gives the range, with
//   S(x) = theta'(x) = 1 / (pi (Ai^2(-x) + Bi^2(-x))) in place of sqrt(x), x > 0.
// About a knot sqrt(x) is averaged over a triangle of half-width 2, as far as the weight pi Ai^2 that a wave
// of first order gives it reaches; what the knot reflects is left out.
//
// Error: 1 % of the slope at x = 2.5, from where on the difference to rays is faded out up to kSteepTurning;
// at a boundary ends nearer to it than a length of Airy are not resolved. Free functions: calls may overlap
// between threads.
#pragma once

namespace halocline::acoustics {

inline constexpr double kSteepTurning = 5, kDeepTurning = -4;  // of x: beyond, rays are their own

struct TurningShare {
  double sine;   // S(x) less sqrt(x) of a ray that gets there, of s0
  double slope;  // 2 S'(x), of which 1 / s0 is in place of 1 / s
  double phase;  // theta less (2/3) x^(3/2) of a ray that gets there, rad; of a knot times omega |D| s0^3 / 2
};
// For x from kDeepTurning to kSteepTurning.
TurningShare turning_at_boundary(double x);
TurningShare turning_at_knot(double x);

inline constexpr double kKnotHalfWidth = 2;  // of x, of the triangle
// How many times s0^2 the unit of x may be at a knot at which 1 / gradient changes by `change` times its
// greater value, for phases to stay as they are within 0.05 rad: waves do not see the knots of a smooth
// profile. At least 1.
double knot_widening(double change);

// s0.
double turning_sine(double gradient_per_s, double frequency_hz);

}  // namespace halocline::acoustics
