// SPDX-License-Identifier: BSD-3-Clause
// Layer of wind-made bubbles below the surface: attenuation along paths of sound.
//
// Model. At the depth z the layer attenuates by (A0 / L) exp(-z / L) dB/m, with f in kHz and the wind U in
// m/s:
//
//   A0 = 0.63e-3 max(U, 6)^1.57 f^0.85 dB, below 6 m/s times exp(1.2 (U - 6))
//   L  = 0.4 + 0.115 max(U - 7.5, 0) m
//
// A0, the loss of one vertical way, is half of a bounce of APL-UW TR 9407 (boundary_reflection.h), so that a
// bounce between deep ends comes out the same. L is that of Hall 1989 and of Keiffer, Novarini and Norton
// 1995. Left out: the slower sound within the layer, and clouds that come and go; because these are patchy a
// path loses at most kMaxBubblePathDb (a choice).
#pragma once

namespace halocline::acoustics {

inline constexpr double kMaxBubbleBounceDb = 15;  // greatest loss of one bounce in the transport of power, dB
inline constexpr double kMaxBubblePathDb = 30;    // greatest loss of a path near the surface, dB

struct BubbleLayer {
  double one_way_db = 0;     // A0
  double e_folding_m = 0.4;  // L

  // Attenuation at a depth >= 0, dB/m.
  double db_per_m(double depth_m) const;
  // Loss of a straight path between two depths >= 0 that is `length_m` long, dB:
  //   A0 (exp(-z1 / L) - exp(-z2 / L)) / |z2 - z1| length
  double straight_loss_db(double from_m, double to_m, double length_m) const;
};

// Layer under a wind of 0..60 m/s at a frequency of 1e3..1e6 Hz. Without wind there is none.
BubbleLayer bubble_layer(double wind_mps, double frequency_hz);

}  // namespace halocline::acoustics
