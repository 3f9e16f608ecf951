// SPDX-License-Identifier: BSD-3-Clause
// Convolutional codes of rate 1/2: distance spectrum, and bit error rate after Viterbi decoding.
//
// Distance spectrum: every path of the trellis that leaves the all-zero path once and comes back, counted by
// its distance d (ones sent) and the ones of information it carries; a_d paths, B_d ones in all. Computed
// from the generators, exactly.
//
// Bit error after a maximum-likelihood (Viterbi) decoder, by the union bound P_b <= sum over d of B_d P2(d),
// each coded bit a chip of binary FSK detected without phase, g its Ec/N0 (Proakis, Digital Communications,
// 4th edition, sections 8.2 and 12.1, 14.4):
//   soft, no fading:  P2 = 2^(1-2d) e^(-d g/2) sum_{k<d} (d g/2)^k / k! sum_{n<d-k} C(2d-1, n)
//                     (square-law sum of d chips)
//   soft, Rayleigh:   P2 = p^d sum_{k<d} C(d-1+k, k) (1-p)^k with p = 1 / (2 + g), chips fade independently
//   hard:             P2 = sum_{k>d/2} C(d, k) p^k (1-p)^(d-k), half of the term k = d/2, with p = e^(-g/2) /
//                     2 or 1 / (2 + g)
// For JANUS's code the first nine terms, d = 12, 14 .. 28, are summed: from chips of 7 dB on (soft, no
// fading) the tenth adds less than 1 part in 10^3. Below that the bound is loose, and above 1 at last: as a
// probability it is capped to 1/2, a guess. Measured codes are better than the bound, never worse. Left out:
// the end of the packet (a few bits more certain), interleavers too short for the fading.
#pragma once

#include <array>
#include <vector>

#include "acoustics/modem/bit_error.h"
#include "core/units.h"

namespace halocline::acoustics {

// Generators as the literature writes them, the newest bit in the highest place.
struct ConvolutionalCode {
  int constraint_length;               // 2..16
  std::array<unsigned, 2> generators;  // below 2^constraint_length
};

// JANUS (ANEP-87, NATO 2017): constraint length 9, generators 753 and 561, octal.
inline constexpr ConvolutionalCode kJanusCode{9, {0753, 0561}};

struct SpectrumTerm {
  int distance;             // d
  double paths;             // a_d, exact below 2^53
  double information_ones;  // B_d, exact below 2^53
  bool operator==(const SpectrumTerm&) const = default;
};

// The terms with at least one path, up to `max_distance`, d rising. The code must not be catastrophic
// (InvalidArgument: such a code has endless paths of finite distance).
std::vector<SpectrumTerm> distance_spectrum(const ConvolutionalCode& code, int max_distance);

// d = 12 .. 28 of JANUS's code.
const std::vector<SpectrumTerm>& janus_spectrum();

enum class Decision { kSoft, kHard };

// The union bound itself, which may be far above 1. Falls as chip_snr (Ec/N0, >= 0) rises.
double union_bound(const std::vector<SpectrumTerm>& spectrum, Decision decision, Fading fading,
                   PowerRatio chip_snr);

// The same as a probability: at most 0.5.
double coded_bit_error_rate(const std::vector<SpectrumTerm>& spectrum, Decision decision, Fading fading,
                            PowerRatio chip_snr);

}  // namespace halocline::acoustics
