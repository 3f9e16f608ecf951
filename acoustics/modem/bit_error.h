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
// Fades last for a bit or longer. packet_error_rate() treats the bits of a packet as independent, which in
// fading represents bits interleaved over many fades.
//
// Exact for white Gaussian noise, a matched filter and perfect timing; interference counts as such noise.
// Left out: intersymbol interference, phase noise, error correction (convolutional_code.h, block_code.h).
//
// Eb/N0 is a PowerRatio, so that a level in decibels cannot be passed by mistake:
//
//   const double errors =
//       bit_error_rate(Modulation::kBpsk, Fading::kNone, to_power_ratio(Decibels{9.6}));  // 9.7e-6
#pragma once

#include <cstdint>

#include "core/units.h"

namespace halocline::acoustics {

enum class Modulation { kBpsk, kDbpsk, kCoherentBfsk, kNoncoherentBfsk };
enum class Fading { kNone, kRayleigh };

// Bit error rate, 0..0.5, decreasing with eb_over_n0 (>= 0, infinity included); tiny values keep their
// relative precision.
double bit_error_rate(Modulation modulation, Fading fading, PowerRatio eb_over_n0);

// Probability that at least one of `bits` (>= 0) independent bits is wrong, each with the probability
// bit_error_rate (0..1): 1 - (1 - p)^n; tiny values keep their relative precision.
double packet_error_rate(double bit_error_rate, std::int64_t bits);

}  // namespace halocline::acoustics
