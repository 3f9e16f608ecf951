// SPDX-License-Identifier: BSD-3-Clause
// Shannon capacity of a straight link, bit/s.
//
// Model (Stojanovic 2006; equation 8 of the 2010 IEEE SMC paper):
//   C(l) = integral over the band of  log2(1 + (P/B) / (A(l, f) N(f))) df,
// the power P spread evenly over the bandwidth B, A the loss l^k 10^(alpha l / 10^4), N the noise density, f
// in Hz. Absorption and noise change over the band, so that a value at its centre is not sufficient. The
// integral has a relative error of 1e-9 (frequency_band.h). The capacity is Shannon's bound: no modem reaches
// it. Left out: multipath, fading, Doppler.
#pragma once

#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/noise.h"
#include "core/units.h"

namespace halocline::acoustics {

// A link through homogeneous water.
struct UniformLink {
  Decibels source_level;  // dB re 1 uPa at 1 m, over the whole band
  double range_m;         // >= 0; below 1 m there is no loss
  double spreading_exponent;
  AbsorptionSpectrum absorption;
  NoiseSources noise;
};

// Capacity over `band`, bit/s.
double capacity_bps(const UniformLink& link, const Band& band);

// Narrow-band capacity, bit/s, which takes the values at the centre for the whole band:
//   B log2(1 + (P/B) / (A(fc) N(fc))).
double narrowband_capacity_bps(const UniformLink& link, const Band& band);

// log2(1 + x), without loss of digits for small x.
double log2_of_1_plus(double x);

}  // namespace halocline::acoustics
