// SPDX-License-Identifier: BSD-3-Clause
// Variation of the ambient noise about its spectrum: slow changes and bursts.
//
// Slow changes: a Gauss-Markov process in dB (core/gauss_markov.h) is added to the level of the spectrum; it
// is the same for all frequencies and places of a run. Its mean -sigma^2 ln(10) / 20 preserves the mean
// power.
//
// Day and night: over a reef the level rises from noon to midnight by `day_night_db` and falls again, as
//   day_night_db (1 - cos(2 pi (t - noon) / 86400 s)) / 2
// (the cosine is our choice; snapping shrimp are louder at night: Johnson, Everest and Young 1947).
//
// Bursts (snapping shrimp, cracking ice): symmetric alpha-stable noise of exponent alpha, as a sub-Gaussian
// process. Over each burst the noise is normal with the power g A, where g is `burst_level` over the noise of
// the spectrum and A is positive and (alpha / 2)-stable with
//   E exp(-s A) = exp(-s^(alpha / 2))
// (Samorodnitsky and Taqqu 1994, proposition 1.3.1; for ocean noise: Chitre, Potter and Ong 2006). With U
// uniform in (0, pi), W exponential and a = alpha / 2 (Kanter 1975),
//   A = sin(a U) / sin(U)^(1 / a) (sin((1 - a) U) / W)^((1 - a) / a).
// The mean of A is infinite, so only medians and quantiles are meaningful. Each receiver has its own bursts,
// one after another and independent of each other. At alpha = 2 the noise is Gaussian, with A = 1. Where the
// bursts are a part of the spectrum's level (a reef as measured), they are not drawn beside it: a receiver
// that takes them for Gaussian noise loses what its modem states.
//
// Random numbers are addressed by seed, receiver and burst.
#pragma once

#include <cstdint>

#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

// Parameters of the variation.
struct NoiseVariation {
  double spread_db = 0;                                    // standard deviation of the slow changes, 0..30
  double spread_time_s = 600;                              // their correlation time, 0.1..1e6
  double burst_exponent = 0;                               // alpha, 0.5..2; 0: no bursts
  Decibels burst_level{0};                                 // g over the noise of the spectrum, -100..100
  SimDuration burst = SimDuration::from_milliseconds(10);  // duration of a burst, 1 ms to 60 s
  bool bursts_within_level = false;  // they are a part of the spectrum's level, and not drawn
  double day_night_db = 0;           // rise of the level from noon to midnight, 0..20
  double noon_s = 0;                 // simulation time of a noon, s, -1e6..1e6

  // True when the noise is far from Gaussian.
  bool has_bursts() const { return burst_exponent > 0; }
  // True when bursts are drawn beside the noise of the spectrum.
  bool draws_bursts() const { return has_bursts() && !bursts_within_level; }
  // True when noise_offset() may differ from 0.
  bool changes_level() const { return spread_db > 0 || day_night_db > 0; }
  bool operator==(const NoiseVariation&) const = default;
};

// Throws InvalidArgument, naming the field, unless every field is in range.
void validate(const NoiseVariation& variation);

// Deviation of the level at `at` from that of the spectrum, by slow changes and the time of the day; 0
// without either.
Decibels noise_offset(const NoiseVariation& variation, std::uint64_t seed, SimTime at);

// A of one burst, numbered from time 0, at one receiver.
double burst_power(double exponent, std::uint64_t seed, std::uint32_t receiver, std::int64_t burst);

}  // namespace halocline::acoustics
