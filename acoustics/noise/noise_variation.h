// SPDX-License-Identifier: BSD-3-Clause
// How the ambient noise varies about its spectrum: slowly, and in bursts.
//
// Slowly: the level is its spectrum's plus a Gauss-Markov process in dB (core/gauss_markov.h), one for all
// frequencies and all places of a run.
//
// In bursts (snapping shrimp, cracking ice): symmetric alpha-stable noise, of exponent alpha, as a
// sub-Gaussian process: normal noise whose power over each burst is g A, g the stated power and A positive
// and (alpha / 2)-stable with
//     E exp(-s A) = exp(-s^(alpha / 2))
// (Samorodnitsky and Taqqu 1994, proposition 1.3.1; of ocean noise: Chitre, Potter and Ong 2006). With U
// uniform in (0, pi), W exponential and a = alpha / 2 (Kanter 1975),
//     A = sin(a U) / sin(U)^(1 / a) (sin((1 - a) U) / W)^((1 - a) / a).
// The mean of A is infinite: only medians and quantiles mean anything. Each receiver has its own bursts, back
// to back, independent of each other. At alpha = 2, A is 1: Gaussian.
//
// Draws are addressed by seed, receiver and burst.
#pragma once

#include <cstdint>

#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

struct NoiseVariation {
  double spread_db = 0;                                    // standard deviation, 0..30
  double spread_time_s = 600;                              // its correlation time, 0.1..1e6
  double burst_exponent = 0;                               // alpha, above 0.5, at most 2; 0: no bursts
  Decibels burst_level{0};                                 // of g, over the noise of the spectrum, -100..100
  SimDuration burst = SimDuration::from_milliseconds(10);  // 1 ms to 60 s

  bool has_bursts() const { return burst_exponent > 0; }
  bool operator==(const NoiseVariation&) const = default;
};

// Throws InvalidArgument, naming the field, unless all are in range.
void validate(const NoiseVariation& variation);

// By how much the level at `at` is off the spectrum's; 0 without a spread.
Decibels noise_offset(const NoiseVariation& variation, std::uint64_t seed, SimTime at);

// A of one burst, counted from time 0, at one receiver.
double burst_power(double exponent, std::uint64_t seed, std::uint32_t receiver, std::int64_t burst);

}  // namespace halocline::acoustics
