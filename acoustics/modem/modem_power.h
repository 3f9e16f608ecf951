// SPDX-License-Identifier: BSD-3-Clause
// The electric power that a modem takes to transmit.
//
// Model: a source of acoustic power P_a in all directions has SL = 170.8 + 10 log10(P_a) dB re 1 uPa at 1 m
// (Urick 1983, section 4.2, in sea water); one that concentrates it by DI has that much more. So
//     P = 10^((SL - 170.8 - DI) / 10) / efficiency.
// The transducer is the same both ways: DI is the modem's directivity index of reception.
#pragma once

#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// The level at 1 m of a watt that is radiated in all directions, dB re 1 uPa (Urick 1983).
inline constexpr double kLevelOfAWatt = 170.8;

// W while it transmits; `efficiency` is acoustic over electric power, 0.001 to 1.
double transmit_power_w(const Modem& modem, double efficiency);

}  // namespace halocline::acoustics
