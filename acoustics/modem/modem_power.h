// SPDX-License-Identifier: BSD-3-Clause
// Electric power of a modem while it transmits.
//
// Model: an omnidirectional source of the acoustic power P_a, W, has SL = 170.8 + 10 log10(P_a) dB re 1 uPa
// at 1 m (Urick 1983, section 4.2, in sea water); a directivity index DI raises it by that many dB. Hence
//   P = 10^((SL - 170.8 - DI) / 10) / efficiency.
// The transducer is reciprocal: DI is the modem's directivity index of reception.
#pragma once

#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// Source level of 1 W radiated omnidirectionally, dB re 1 uPa at 1 m (Urick 1983).
inline constexpr double kLevelOfAWatt = 170.8;

// Electric power while transmitting, W; `efficiency` is acoustic over electric power, 0.001 to 1.
double transmit_power_w(const Modem& modem, double efficiency);

}  // namespace halocline::acoustics
