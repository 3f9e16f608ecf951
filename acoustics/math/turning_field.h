// SPDX-License-Identifier: BSD-3-Clause
// The wave field of rays that turn close to a boundary, or close to a knot at which the gradient of the sound
// speed changes.
//
// Model. Let s be the sine of a ray's angle at the boundary or knot, with s^2 < 0 for a ray that turns before
// it, and D the change of 1 / gradient there. Rays gather
//   the range D s / xi  and the phase  omega D s^3 / 3.
// Both have a kink at s = 0, so amplitudes of plain ray theory jump between 0, infinity and the amplitude of
// the ray that turns. The field of a wave is smooth on the scale
//   s0 = (2 g / omega)^(1/3),  x = s^2 / s0^2.
// Where the speed is linear in depth the field is an Airy function of the depth; its scale, the Airy length,
// is c s0^2 / (2 g).
//
// Boundary. Before a boundary of zero pressure (the surface, or the bottom at grazing) the field is the
// combination of Ai and Bi that vanishes there. Relative to a wave that turns, the reflected wave has the
// phase
//   2 theta(x),  theta = atan(Ai(-x) / Bi(-x)),
// which rises from 0 deep below the boundary to (4/3) x^(3/2) + pi / 2, the phase of a reflected ray
// (Brekhovskikh and Godin 1999, chapter 3; Murphy and Davis 1974, JASA 56, 1747: rays of modified range). The
// slope of theta gives the range: for x > 0, sqrt(x) is replaced by
//   S(x) = theta'(x) = 1 / (pi (Ai^2(-x) + Bi^2(-x))).
//
// Knot. sqrt(x) is averaged over a triangle of half-width 2 in x, which is how far the weight pi Ai^2 of a
// wave of first order reaches. The reflection by the knot is neglected.
//
// Error: 1 % of the slope at x = 2.5, from where on the difference to ray theory is faded out up to
// kSteepTurning. At a boundary, ends nearer to it than an Airy length are not resolved.
//
// Thread rule: free functions, which threads may call at the same time.
#pragma once

namespace halocline::acoustics {

// Limits of x; beyond them plain ray theory holds.
inline constexpr double kSteepTurning = 5, kDeepTurning = -4;

// Differences between the wave field and plain ray theory.
struct TurningShare {
  double sine;   // S(x) less sqrt(x) of a ray that reaches the place, in units of s0
  double slope;  // 2 S'(x); in units of 1 / s0 it replaces 1 / s
  // theta less (2/3) x^(3/2) of a ray that reaches the place, rad; at a knot to be multiplied by
  // omega |D| s0^3 / 2
  double phase;
};
// Differences at a boundary and at a knot, for x from kDeepTurning to kSteepTurning.
TurningShare turning_at_boundary(double x);
TurningShare turning_at_knot(double x);

inline constexpr double kKnotHalfWidth = 2;  // half-width of the triangle, in x
// The factor, at least 1, by which the unit of x at a knot may exceed s0^2 so that phases stay the same
// within 0.05 rad. `change` is the change of 1 / gradient relative to its greater value. Waves do not resolve
// the knots of a smooth profile, whose changes are small.
double knot_widening(double change);

// The scale of sines, s0 = (2 g / omega)^(1/3) = (g / (pi f))^(1/3).
double turning_sine(double gradient_per_s, double frequency_hz);

}  // namespace halocline::acoustics
