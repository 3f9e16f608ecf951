// SPDX-License-Identifier: BSD-3-Clause
// Probability of detecting a packet's preamble in noise.
//
// Model: the receiver filters the preamble in M pieces, each with a matched filter, and adds the squared
// outputs (M = 1: a sweep matched as a whole, phase unknown; M > 1: chips added incoherently). For noise
// alone the sum is chi-square with 2M degrees of freedom, with a signal non-central chi-square (Marcum 1960;
// Kay, Fundamentals of Statistical Signal Processing: Detection Theory, 1998, section 7.6). The threshold
// follows from the probability of a false alarm at one tested instant. With h the ratio of the whole
// preamble's energy to the noise density (time-bandwidth product times signal-to-noise ratio in the band) and
// T half the threshold,
//   P_detect = 1 - sum over n >= M of  e^-T T^n / n!  P(a Poisson variable of mean h is at most n - M),
// which is Marcum's Q_M(sqrt(2 h), sqrt(2 T)) in a form without cancellation; exact to 1e-12. Left out:
// search over time and Doppler (it is part of the false alarm rate), fading, adaptive thresholds.
#pragma once

#include "core/units.h"

namespace halocline::acoustics {

// Half the threshold, T, of `pieces` (1..256) that noise alone exceeds with the probability `false_alarm`
// (1e-15..0.5).
double detection_threshold(int pieces, double false_alarm);

// Probability of detection; it increases smoothly with the energy, from `false_alarm` at 0 to 1.
double detection_probability(int pieces, double false_alarm, PowerRatio energy_over_noise_density);

}  // namespace halocline::acoustics
