// SPDX-License-Identifier: BSD-3-Clause
// The best frequencies for a link of a given length, and the power and capacity they need and give.
//
// Model: Stojanovic 2006, "On the relationship between capacity and distance in an underwater acoustic
// communication channel" (WUWNet). The product A(l, f) N(f) of loss and noise has one minimum in f: the
// optimum frequency. Around it,
//   - 3 dB band: where A N stays within twice the minimum; flat spectrum of the power that gives the target
//   SNR,
//     P = SNR B (integral of N) / (integral of 1 / A); C = integral of log2(1 + (P/B) / (A N));
//   - water-filling: spectrum S(f) = K - A N where positive, K such that
//     (integral of S / A) / (integral of N) = SNR; C = integral of log2(K / (A N)).
// Absorption is that of one place. Edges, optimum and K are found to 1e-12 relative; matches the published
// table's computation to its ten digits. Valid where A N has one minimum between kLowest and kHighest
// frequency. Left out: multipath, limits of transducers.
#pragma once

#include "acoustics/link/capacity.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/noise.h"
#include "core/units.h"

namespace halocline::acoustics {

// Distance, water and the signal-to-noise ratio to reach.
struct OptimumBandQuestion {
  double range_m;  // 1..1e6
  double spreading_exponent;
  AbsorptionSpectrum absorption;
  NoiseSources noise;
  Decibels target_snr;  // mean over the band, at the receiver
};

// A band with the power it takes and what it carries.
struct BandPlan {
  Band band;
  Decibels source_level;  // P, dB re 1 uPa at 1 m over the band
  double capacity_bps;
};

struct OptimumBand {
  double optimum_frequency_hz;
  Decibels min_loss_and_noise;  // A N at the optimum, dB re 1 uPa^2/Hz
  BandPlan flat;                // 3 dB band
  BandPlan water_filling;
};

OptimumBand optimum_band(const OptimumBandQuestion& question);

}  // namespace halocline::acoustics
