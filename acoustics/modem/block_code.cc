// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/block_code.h"

#include <algorithm>

#include "acoustics/modem/bit_error.h"

namespace halocline::acoustics {

const BlockCode& bch_64_10() {
  static const BlockCode code{64, 10, {{28, 448}, {32, 126}, {36, 448}, {64, 1}}};
  return code;
}

const BlockCode& hamming_14_9() {
  static const BlockCode code{14, 9, {{4, 77}, {6, 168}, {8, 203}, {10, 56}, {12, 7}}};
  return code;
}

double coded_bit_error_rate(const BlockCode& code, PowerRatio eb_over_n0) {
  // Union bound (Proakis, 4th edition, section 8.1):
  //   P_b <= sum over w of (w / n) A_w Q(sqrt(2 w (k / n) Eb/N0)).
  const double rate = static_cast<double>(code.information_bits) / code.length;
  double sum = 0;
  for (const BlockCode::Weight& weight : code.weights) {
    // Q(sqrt(2 x)) is the bit error rate of BPSK at Eb/N0 = x.
    const PowerRatio x{weight.ones * rate * eb_over_n0.value};
    sum += weight.words * weight.ones / code.length * bit_error_rate(Modulation::kBpsk, Fading::kNone, x);
  }
  return std::min(0.5, sum);
}

}  // namespace halocline::acoustics
