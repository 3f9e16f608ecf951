// SPDX-License-Identifier: BSD-3-Clause
// The optimum frequency and bands of a link of a given length, with the power they need and the capacity they
// give.
//
// Model: Stojanovic 2006, "On the relationship between capacity and distance in an underwater acoustic
// communication channel" (WUWNet). The product A(l, f) N(f) of loss and noise has one minimum over f: the
// optimum frequency. Two bands are computed around it:
// - 3 dB band: A N is at most twice the minimum; flat spectrum of the power that gives the target SNR,
//     P = SNR B (integral of N) / (integral of 1 / A),  C = integral of log2(1 + (P/B) / (A N)) df.
// - Water-filling: spectrum S(f) = K - A N where positive, with K such that
//     (integral of S / A) / (integral of N) = SNR,      C = integral of log2(K / (A N)) df.
// Absorption is that of one place. Edges, optimum and K have a relative error of 1e-12; the results match the
// published table to its ten digits. Valid where A N has a single minimum between 1 Hz and 10 MHz. Left out:
// multipath, limits of transducers.
#pragma once

#include "acoustics/link/capacity.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/noise.h"
#include "core/units.h"

namespace halocline::acoustics {

// Distance, water, noise and target signal-to-noise ratio.
struct OptimumBandQuestion {
  double range_m;  // 1..1e6
  double spreading_exponent;
  AbsorptionSpectrum absorption;
  NoiseSources noise;
  Decibels target_snr;  // mean over the band, at the receiver
};

// A band with the power that it needs and its capacity.
struct BandPlan {
  Band band;
  Decibels source_level;  // P, dB re 1 uPa at 1 m over the band
  double capacity_bps;
};

// Optimum frequency and the two bands.
struct OptimumBand {
  double optimum_frequency_hz;
  Decibels min_loss_and_noise;  // A N at the optimum, dB re 1 uPa^2/Hz
  BandPlan flat;                // 3 dB band
  BandPlan water_filling;
};

// The optimum frequency and both bands. Throws InvalidArgument when the range is outside of 1..1e6 m.
OptimumBand optimum_band(const OptimumBandQuestion& question);

}  // namespace halocline::acoustics
