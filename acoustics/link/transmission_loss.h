// SPDX-License-Identifier: BSD-3-Clause
// Transmission loss along a straight path.
//
// Model (Urick 1983; Stojanovic 2006):
//   TL(l, f) = k 10 log10(l) + alpha l / 1000,
// l in metres, re 1 m for spreading, and alpha in dB/km. k = 2 is spherical spreading (near, unbounded), 1
// cylindrical (far, ducted), 1.5 practical. Below 1 m the loss is 0: levels refer to 1 m and the law does not
// hold at shorter distances. Left out: refraction, bounces, shadow zones (see acoustics/rays).
#pragma once

#include "core/units.h"

namespace halocline::acoustics {

inline constexpr double kReferenceRange = 1;  // m, reference distance of source levels

// Loss and its parts, dB; each is 0 below 1 m.
struct TransmissionLoss {
  Decibels spreading, absorption, total;
};

// Loss for `range_m` >= 0, `spreading_exponent` 0..3 (1..2 in the sea) and `absorption_db_per_km` >= 0.
TransmissionLoss transmission_loss(double range_m, double spreading_exponent, double absorption_db_per_km);

}  // namespace halocline::acoustics
