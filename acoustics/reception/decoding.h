// SPDX-License-Identifier: BSD-3-Clause
// Whether a packet is detected and decoded, from its ratio of signal to noise and interference over time and
// band.
//
// Model. A packet's information bits lie evenly after its preamble, in blocks: the header and each frame
// (acoustics/modem/packet_format.h).
// - Bits that fade together (PSK, uncoded FSK, and everything without fading): errors do not depend on each
//   other,
//     ln P = sum over cells of bits in the cell * ln(1 - BER(SINR))
// - Coded frequency-shift keying, whose interleaver spreads a block over its time and whose hops spread it
//   over the band, while it fades: the exponential effective ratio of a block's cells, of chips,
//     gamma = -beta ln mean exp(-gamma_i / beta),  P = (1 - BER(gamma))^bits
//   beta = 2.95 lands the JANUS code on its own curve for chips that fade by themselves (Rayleigh) to 0.1 dB
//   (convolutional_code.h).
// A cell is a stretch of constant interference at one frequency.
#pragma once

#include <algorithm>
#include <cstdint>

#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

inline constexpr double kEffectiveRatioBeta = 2.95;

// Energy of a chip of a code of rate 1/2 over the noise density, for a ratio of 1 in the band: B / (2 R).
double chip_energy(const Modem& modem);

// Gathers the cells of one block.
class BlockDecoder {
 public:
  // `fades`: the signal varies within the packet.
  BlockDecoder(const Modem& modem, bool fades);
  // `share` of the block's bits, 0..1, has the ratio `sinr` >= 0 in the modem's band.
  void add(double share, double sinr);
  // The probability that all `bits` of the block are right.
  double success(std::int64_t bits) const;

 private:
  const Modem& modem_;
  bool interleaved_;
  double sum_ = 0;  // of exp(-gamma / beta), or of ln(1 - BER), by share
};

}  // namespace halocline::acoustics
