// SPDX-License-Identifier: BSD-3-Clause
// The field about a fold of rays: a caustic, on one side of which two rays of one family pass and on the
// other none.
//
// Model. With x the distance to the caustic in lengths of Airy, positive on the lit side, the field of two
// rays of amplitude A each is uniformly (Ludwig 1966; Brekhovskikh and Godin 1999, chapter 3)
//   C Ai(-x),  C = 2 sqrt(pi) x^(1/4) A,  omega dt = (4/3) x^(3/2),
// dt between the two in time; C stays finite where A does not. Ai(-x) = M cos(phi), M^2 = Ai^2 + Bi^2: each
// ray has the amplitude C M / 2, and the two turn by phi and -phi about their mean phase. On the dark side, x
// < 0, the field decays like Ai: one path at the launch angle and in the phase of the fold itself. About the
// fold, up to where the two are in quadrature, their sum is one path too: what each of them scatters does not
// appear or vanish at once.
//
// Error: fields of two rays of different amplitudes differ by a term in Ai' that is left out. Free functions:
// calls may overlap between threads.
#pragma once

namespace halocline::acoustics {

inline constexpr double kLitFold = 4;        // of x: further on the lit side the rays are their own, to 0.1 %
inline constexpr double kMergedFold = 0.37;  // nearer, two rays are one path: Ai = Bi
inline constexpr double kDarkFold =
    -2.5;  // further in the dark there is no path, 31 dB below the greatest field

// x of the two rays of a fold `time_s` apart.
double fold_place(double time_s, double frequency_hz);

// What remains of the amplitude of each of two rays at x > 0, and by how much the phase grows of the ray that
// has touched a caustic less, and falls of the other, rad.
struct FoldShare {
  double factor = 1, phase_rad = 0;
};
FoldShare fold_share(double x);

// A fold in the plane of a coordinate of the receiver, by what its rays do about it: u where they arrive, p
// the slowness along u, per radian of launch angle (or any other number that names rays).
struct Fold {
  double curvature;       // d2u, of u as it turns
  double slowness_slope;  // dp, s/m

  // Of Airy, m of u: (|d2u| / (2 omega^2 dp^2))^(1/3).
  double length_m(double frequency_hz) const;
  // |du| of a single ray whose tube gives it the amplitude C Ai(-x), `x` <= 0: sqrt(2 L |d2u|) / (4 pi Ai^2).
  double tube_slope(double x, double frequency_hz) const;
};

}  // namespace halocline::acoustics
