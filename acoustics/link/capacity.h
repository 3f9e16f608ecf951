// SPDX-License-Identifier: BSD-3-Clause
// Shannon capacity of a straight link, bit/s.
//
// Model: C(l) = integral over the band of log2(1 + (P/B) / (A(l, f) N(f))) df (Stojanovic 2006; equation 8 of
// the 2010 IEEE SMC paper), P spread evenly over the bandwidth B, A the loss l^k 10^(alpha l / 10^4), N the
// noise density; f in Hz, result in bit/s. Absorption and noise change over the band, so a value at its
// centre is not enough. Integral to 1e-9 (frequency_band.h). Shannon's bound: no modem reaches it. Left out:
// multipath, fading, Doppler.
#pragma once

#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/noise.h"
#include "core/units.h"

namespace halocline::acoustics {

// A link through water that is the same everywhere.
struct UniformLink {
  Decibels source_level;  // dB re 1 uPa at 1 m, over the whole band
  double range_m;         // >= 0; below 1 m nothing is lost
  double spreading_exponent;
  AbsorptionSpectrum absorption;
  NoiseSources noise;
};

// bit/s over `band`.
double capacity_bps(const UniformLink& link, const Band& band);

// bit/s if the whole band were like its centre: B log2(1 + (P/B) / (A(fc) N(fc))).
double narrowband_capacity_bps(const UniformLink& link, const Band& band);

// log2(1 + x), without loss of digits for small x.
double log2_of_1_plus(double x);

}  // namespace halocline::acoustics
