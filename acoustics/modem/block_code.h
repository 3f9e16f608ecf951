// SPDX-License-Identifier: BSD-3-Clause
// Bit error rate of a linear block code on phase-shift keying after decoding.
//
// Model: union bound of maximum-likelihood soft decoding (Proakis, Digital Communications, 4th edition,
// section 8.1),
//   P_b <= sum over weights w of (w / n) A_w Q(sqrt(2 w (k / n) Eb/N0)),
// A_w the number of code words of weight w; white Gaussian noise, coherent detection. The bound is tight
// where it is small; it is capped at 1/2. Errors occur in bursts of a code word, so that a packet of
// independent bits with this error rate is lost slightly more often than a real one (0.4 dB at (14, 9)). Half
// of the frames of WHOI's rate 5 fail at 5.6 dB; the published value is 3.9 dB.
#pragma once

#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

// A linear block code with its weight distribution.
struct BlockCode {
  struct Weight {
    int ones;      // w
    double words;  // A_w
  };
  int length;                   // n, coded bits of a word
  int information_bits;         // k
  std::vector<Weight> weights;  // all words except the zero word
};

// Extended BCH code (64, 10), distance 28 (MacWilliams and Sloane 1977): weights 28, 32, 36 and 64.
const BlockCode& bch_64_10();
// Extended Hamming code (16, 11), distance 4, shortened by two bits to (14, 9). The code is the Reed-Muller
// code of order 2, in which all pairs of positions are equivalent: for any two omitted bits, the
// shortened code has
//   A_w (16 - w) (15 - w) / 240
// words of weight w, A_w that of the full code.
const BlockCode& hamming_14_9();

// Bit error rate, 0..0.5, decreasing with eb_over_n0 (>= 0, per information bit).
double coded_bit_error_rate(const BlockCode& code, PowerRatio eb_over_n0);

}  // namespace halocline::acoustics
