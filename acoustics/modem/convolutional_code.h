// SPDX-License-Identifier: BSD-3-Clause
// Convolutional codes of rate 1/2: distance spectrum, and bit error rate after Viterbi decoding.
//
// Distance spectrum: all paths of the trellis that leave the all-zero path once and return, counted by their
// distance d (ones sent) and their ones of information: a_d paths with B_d ones in total. It is computed
// exactly from the generators.
//
// Bit error rate after a maximum-likelihood (Viterbi) decoder, by the union bound P_b <= sum over d of B_d
// P2(d); each coded bit is a chip of non-coherently detected binary FSK, g its Ec/N0 (Proakis, Digital
// Communications, 4th edition, sections 8.2, 12.1 and 14.4):
//   soft, no fading:  P2 = 2^(1-2d) e^(-d g/2) sum_{k<d} (d g/2)^k / k! sum_{n<d-k} C(2d-1, n)
//                     (square-law sum of d chips)
//   soft, Rayleigh:   P2 = p^d sum_{k<d} C(d-1+k, k) (1-p)^k,  p = 1 / (2 + g), chips fade independently
//   hard:             P2 = sum_{k>d/2} C(d, k) p^k (1-p)^(d-k), with half of the term k = d/2,
//                     p = e^(-g/2) / 2 without fading, 1 / (2 + g) with it
// For the JANUS code the first nine terms, d = 12, 14 .. 28, are summed: from chips of 7 dB on (soft, no
// fading) the tenth adds less than 1 part in 10^3. At lower ratios the bound is loose and finally exceeds 1:
// as a probability it is capped at 1/2, a guess. Measured codes are better than the bound, never worse. Left
// out: termination of the packet (a few bits are more reliable), interleavers that are too short for the
// fading.
#pragma once

#include <array>
#include <vector>

#include "acoustics/modem/bit_error.h"
#include "core/units.h"

namespace halocline::acoustics {

// Generators in the notation of the literature, the newest bit in the most significant place.
struct ConvolutionalCode {
  int constraint_length;               // 2..16
  std::array<unsigned, 2> generators;  // below 2^constraint_length
};

// JANUS (ANEP-87, NATO 2017): constraint length 9, generators 753 and 561, octal.
inline constexpr ConvolutionalCode kJanusCode{9, {0753, 0561}};

// One distance of the spectrum.
struct SpectrumTerm {
  int distance;             // d
  double paths;             // a_d, exact below 2^53
  double information_ones;  // B_d, exact below 2^53
  bool operator==(const SpectrumTerm&) const = default;
};

// Terms with at least one path, up to `max_distance`, in ascending order of d. Throws InvalidArgument for a
// catastrophic code, which has infinitely many paths of finite distance.
std::vector<SpectrumTerm> distance_spectrum(const ConvolutionalCode& code, int max_distance);

// Terms d = 12 .. 28 of the JANUS code.
const std::vector<SpectrumTerm>& janus_spectrum();

// Decisions on the chips before decoding.
enum class Decision { kSoft, kHard };

// The union bound, which may be far above 1. It decreases with chip_snr (Ec/N0, >= 0).
double union_bound(const std::vector<SpectrumTerm>& spectrum, Decision decision, Fading fading,
                   PowerRatio chip_snr);

// The union bound as a probability, at most 0.5.
double coded_bit_error_rate(const std::vector<SpectrumTerm>& spectrum, Decision decision, Fading fading,
                            PowerRatio chip_snr);

}  // namespace halocline::acoustics
