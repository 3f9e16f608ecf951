// SPDX-License-Identifier: BSD-3-Clause
// Probability that the bits of a packet are decoded correctly, given the ratio of signal to noise and
// interference (SINR) over the packet's time and band.
//
// Model. The information bits of a packet are spread evenly over the time after its preamble, in blocks: the
// header and each frame (acoustics/modem/packet_format.h). A cell is a stretch of constant interference at
// one frequency.
// - Blocks without interleaving over fading (PSK, uncoded FSK, and every modem when nothing fades) have
//   independent errors:
//     ln P = sum over cells of  (bits in the cell) ln(1 - BER(SINR)).
// - Coded frequency-shift keying while the signal fades: the interleaver spreads a block over its time and
//   the hops spread it over the band. The block has the exponential effective ratio gamma of the ratios
//   gamma_i of its cells, per chip:
//     gamma = -beta ln mean exp(-gamma_i / beta),  P = (1 - BER(gamma))^bits.
//   beta: kEffectiveRatioBeta of convolutional_code.h.
#pragma once

#include <cstdint>

#include "acoustics/modem/convolutional_code.h"
#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// Energy of a chip over the noise density for a code of rate 1/2 at a ratio of 1 in the band: B / (2 R), B
// the bandwidth and R the bit rate.
double chip_energy(const Modem& modem);

// Accumulates the cells of one block and returns its probability of success.
class BlockDecoder {
 public:
  // `fades` is true when the signal varies within the packet.
  BlockDecoder(const Modem& modem, bool fades);
  // Adds a cell: `share` of the block's bits, 0..1, at the ratio `sinr` >= 0 in the modem's band.
  void add(double share, double sinr);
  // Probability that all `bits` of the block are correct.
  double success(std::int64_t bits) const;

 private:
  const Modem& modem_;
  bool interleaved_;
  double sum_ = 0;  // sum, weighted by share, of exp(-gamma / beta) or of ln(1 - BER)
};

}  // namespace halocline::acoustics
