// SPDX-License-Identifier: BSD-3-Clause
// Errors of symbols that are one of 16 orthogonal codes, detected without phase, with parity.
//
// Model (Proakis, 4th edition, section 5.4.2), g the ratio of a symbol's energy to the noise density:
//   P_s = sum over n = 1..15 of  (-1)^(n+1) C(15, n) / (n + 1) exp(-g n / (n + 1)).
// A symbol carries 4 bits, g = 4 G Eb/N0. G is the gain of the parity, 0.4 dB: fitted to the packet errors of
// 16 bytes that the makers of NM3 publish for their receiver without echoes. The four bits of a wrong symbol
// are wrong together, so the result is the error rate of independent bits of which four are right as often as
// the symbol: 1 - (1 - P_s)^(1/4), at most 0.5. Left out: the threshold of a Reed-Solomon code, above which
// longer packets need more energy than their number of symbols tells.
#pragma once

#include "core/units.h"

namespace halocline::acoustics {

// Probability of a wrong symbol of 16, 0..15/16, for a ratio of its energy to the noise density >= 0.
double orthogonal16_symbol_error_rate(PowerRatio energy_over_noise_density);

// Bit error rate, 0..0.5, decreasing with eb_over_n0 (>= 0).
double orthogonal16_bit_error_rate(PowerRatio eb_over_n0);

}  // namespace halocline::acoustics
