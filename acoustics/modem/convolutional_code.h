// SPDX-License-Identifier: BSD-3-Clause
// Convolutional codes of rate 1/2: distance spectrum, union bound, and the errors of a Viterbi decoder.
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
// as a probability it is capped at 1/2, a guess.
//
// Errors of the JANUS code. The union bound is no estimate of delivery: wrong bits of a Viterbi decoder come
// in bursts, and the bound counts paths again and again. Blocks of 64 bits are half right at chips of 3.35
// dB, where the bound says 5.1 dB. janus_error_events() is the rate of error events instead: a block of n
// bits and 8 of tail is right with the probability (1 - rate)^n. It is tabulated from a decoder simulated on
// chips in white noise, square-law detected, their differences of power added along the trellis
// (tests/acoustics/modem/simulated_viterbi.h): 20 000 blocks of 64 bits a row, 1 to 6 dB in steps of 0.5 dB,
// standard error of the rate 1 % at 3 dB, 6 % at 5 dB, 17 % at 5.5 dB, which is below 0.05 dB. ln(rate) is
// interpolated linearly. Below 1 dB the rate goes to a guess, 1/2 exp(-1.306 g) (choice; no block of 64 is
// right there); above 6 dB it falls as the union bound of events, sum of a_d P2(d), is 0.57 of that, which it
// would reach: at most 0.1 dB too good. Blocks of 256 bits agree within 0.1 dB. A decoder that weighs chips
// by their difference of power over its sum, which bounds loud chips, needs 0.25 dB more.
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

// Rate of error events per information bit of the JANUS code, 0..0.5, for soft decisions on chips in white
// noise; chip_snr is Ec/N0, >= 0. It never increases with chip_snr.
double janus_error_events(PowerRatio chip_snr);

// The effective ratio of chips of unequal ratios g_i is -beta ln mean exp(-g_i / beta): one that has the same
// rate of error events in white noise. With 2.8 it gives the
// packets of the simulated decoder over chips of independent Rayleigh fading to 0.05 dB (8000 blocks of 64
// bits at 4 to 8 dB).
inline constexpr double kEffectiveRatioBeta = 2.8;

// The same rate where each chip fades independently (Rayleigh) about the mean Ec/N0 `mean_chip_snr`: that at
// the effective ratio beta ln(1 + g / beta) of exponentially distributed chips.
double janus_error_events_rayleigh(PowerRatio mean_chip_snr);

// The union bound as a probability, at most 0.5.
double coded_bit_error_rate(const std::vector<SpectrumTerm>& spectrum, Decision decision, Fading fading,
                            PowerRatio chip_snr);

}  // namespace halocline::acoustics
