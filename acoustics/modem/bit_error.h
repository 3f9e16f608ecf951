// SPDX-License-Identifier: BSD-3-Clause
// Bit error rate of uncoded modulations in Gaussian noise and Rayleigh fading.
//
// Model (Proakis, Digital Communications, 4th edition, chapters 5.2 and 14.3), g the ratio Eb/N0, Q the tail
// of the normal distribution:
//
//   modulation          AWGN                 Rayleigh fading over a bit, g the mean
//   BPSK                Q(sqrt(2 g))         (1 - sqrt(g / (1 + g))) / 2
//   DBPSK               exp(-g) / 2          1 / (2 (1 + g))
//   coherent BFSK       Q(sqrt(g))           (1 - sqrt(g / (2 + g))) / 2
//   non-coherent BFSK   exp(-g / 2) / 2      1 / (2 + g)
//
// Fades last a bit and longer. packet_error_rate takes the bits of a packet as independent: in fading that
// stands for bits interleaved over many fades.
//
// Exact for white Gaussian noise, a matched filter and perfect timing; interference counts as such noise.
// Left out: symbols that run into each other, phase noise, error correction (convolutional_code.h,
// block_code.h).
//
// Eb/N0 is a PowerRatio, so a level in decibels cannot be handed over by mistake:
//
//   const double errors = bit_error_rate(Modulation::kBpsk, Fading::kNone, to_power_ratio(Decibels{9.6})); //
//   9.7e-6
#pragma once

#include <cstdint>

#include "core/units.h"

namespace halocline::acoustics {

enum class Modulation { kBpsk, kDbpsk, kCoherentBfsk, kNoncoherentBfsk };
enum class Fading { kNone, kRayleigh };

// 0..0.5, falling as eb_over_n0 (>= 0, infinity included) rises; without loss of digits where it is tiny.
double bit_error_rate(Modulation modulation, Fading fading, PowerRatio eb_over_n0);

// The probability that at least one of `bits` (>= 0) bits is wrong, each with probability bit_error_rate
// (0..1) and none depending on another: 1 - (1 - p)^n, without loss of digits where it is tiny.
double packet_error_rate(double bit_error_rate, std::int64_t bits);

}  // namespace halocline::acoustics
