// SPDX-License-Identifier: BSD-3-Clause
// Probability of detection of a packet's preamble in noise.
//
// Model: the receiver filters the preamble in M pieces, each with a filter matched to it, squares and adds
// (M = 1: a sweep matched as a whole, phase unknown; M > 1: chips added without phase). In noise alone the
// sum is chi-square with 2M degrees of freedom, with a signal non-central chi-square (Marcum 1960; Kay,
// Fundamentals of Statistical Signal Processing: Detection Theory, 1998, section 7.6). The threshold follows
// from the probability of a false alarm, at one instant tested. With h the ratio of the whole preamble's
// energy to the noise density (time-bandwidth product times signal-to-noise ratio in the band) and T half the
// threshold,
//   P_detect = 1 - sum over n >= M of e^-T T^n / n!  P(a Poisson number of mean h is at most n - M),
// which is Marcum's Q_M(sqrt(2 h), sqrt(2 T)) written without a difference of large numbers; exact to 1e-12.
// Left out: search over time and Doppler (that is in the false alarm rate), fading, a threshold that adapts.
#pragma once

#include "core/units.h"

namespace halocline::acoustics {

// Half the threshold, T, of `pieces` (1..256) that noise alone exceeds with probability `false_alarm`
// (1e-15..0.5).
double detection_threshold(int pieces, double false_alarm);

// Rises smoothly from false_alarm at 0 to 1.
double detection_probability(int pieces, double false_alarm, PowerRatio energy_over_noise_density);

}  // namespace halocline::acoustics
