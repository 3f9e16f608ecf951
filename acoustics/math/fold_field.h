// SPDX-License-Identifier: BSD-3-Clause
// The wave field about a fold caustic, on the illuminated side of which two rays of one family pass, and on
// the shadow side none.
//
// Model (Ludwig 1966; Brekhovskikh and Godin 1999, chapter 3). Let x be the distance to the caustic in Airy
// lengths, positive on the illuminated side, and dt the difference in travel time of its two rays of
// amplitude A each. The uniform field is
//   C Ai(-x),  C = 2 sqrt(pi) x^(1/4) A,  omega dt = (4/3) x^(3/2).
// C stays finite where A does not. With Ai(-x) = M cos(phi) and M^2 = Ai^2 + Bi^2, each ray has the amplitude
// C M / 2, and their phases are phi and -phi relative to their mean. On the shadow side, x < 0, the field
// decays like Ai; it is one path with the launch angle and the phase of the caustic itself. Close to the
// caustic on its illuminated side, up to where the two rays are in quadrature, their sum is one path too, so
// that what each of them scatters does not appear or vanish at once.
//
// Error: for two rays of different amplitudes a term in Ai' is neglected.
//
// Thread rule: free functions, which threads may call at the same time.
#pragma once

namespace halocline::acoustics {

inline constexpr double kLitFold = 4;        // x beyond which plain ray theory holds, to 0.1 %
inline constexpr double kMergedFold = 0.37;  // x below which the two rays are one path: Ai = Bi
// x in the shadow beyond which there is no path: 31 dB below the greatest field.
inline constexpr double kDarkFold = -2.5;

// x of the two rays of a fold that arrive `time_s` apart: x = (3/4 omega dt)^(2/3).
double fold_place(double time_s, double frequency_hz);

// The factor on the amplitude of each of the two rays at x > 0, and the phase, rad, that is added to the ray
// that has touched one caustic less and subtracted from the other.
struct FoldShare {
  double factor = 1, phase_rad = 0;
};
FoldShare fold_share(double x);

// A fold caustic as seen in one coordinate u of the receiver, described by its rays: where they arrive, u,
// and their slowness p along u, both as functions of the launch angle in radians (or of any other parameter
// of the rays).
struct Fold {
  double curvature;       // second derivative of u where u turns
  double slowness_slope;  // derivative of p, s/m

  // Airy length L in metres of u: (|d2u| / (2 omega^2 dp^2))^(1/3).
  double length_m(double frequency_hz) const;
  // |du| of a single ray whose tube gives it the amplitude C Ai(-x), for `x` <= 0:
  //   |du| = sqrt(2 L |d2u|) / (4 pi Ai(-x)^2)
  double tube_slope(double x, double frequency_hz) const;
};

}  // namespace halocline::acoustics
