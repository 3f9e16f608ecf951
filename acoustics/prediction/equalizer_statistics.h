// SPDX-License-Identifier: BSD-3-Clause
// Mean signal of an equaliser that combines the whole band, averaged over fading: phase-shift keying.
//
// Model, with h_p the normalised response of path p (mean |h|^2 = 1), x_p its mean power, tau the difference
// of two delays and W the band (signal_history.h):
//   S = sum over pairs of paths p, q of  sqrt(x_p x_q) Re(h_p h_q* exp(-j 2 pi f_c tau)) sinc(W tau).
// The power of a path is shared between a steady part, a part whose phase the medium turns, and a scattered
// part. Scattering so slow that it stays constant through a packet counts as turned by the medium.
// - Block fading (constant through a packet): the steady parts and the parts turned by the medium. Pairs of
//   paths that are less than kNearCycles apart over the band count, with the medium fading that they share
//   (acoustics/fading/link_fading.h). Both ends move vertically from packet to packet: platform jitter
//   (platform_jitter.h).
// - Fast fading (within a packet): the variance of S is the sum over pairs of x_p s_p x_q s_q sinc^2, s the
//   scattered share, plus that of the cross terms with the block-fading power. Where paths cancel each other
//   so do their cross terms: all shrink as the block-fading power does against that of the paths apart.
#pragma once

#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/prediction/gamma_power.h"

namespace halocline::acoustics {

// A path in the guard window or after it. `steady`, `turned` and `scattered` are shares that add to 1.
struct EqualizerPath {
  double signal = 0, interference = 0;  // mean powers, uPa^2
  double steady = 1, turned = 0, scattered = 0;
  double medium = 0;  // share of `turned` that fades with other paths; the rest is slow scattering
  // Delay, and phase at the centre of the band, which includes that of the delay.
  double delay_s = 0, phase_rad = 0;
  double launch_angle_rad = 0, arrival_angle_rad = 0;
  double spread_hz = 0;
};

// The power that one path scatters within a packet.
struct FadingTerm {
  double signal = 0, interference = 0;  // uPa^2
  double unit = 0;  // signal with that of neighbouring paths it fades with: `signal` or more
  double signal_cross_terms = 0, interference_cross_terms = 0;  // block-fading power in cross terms
  double squared_spread = 0;                                    // Hz^2
};

// Statistics of the combined signal over fading.
struct EqualizerStatistics {
  // Distribution of the block-fading power.
  GammaPower block_fading;
  double fast = 0;  // mean power that fades within a packet
  // Variance of the fast-fading power by itself, uPa^4, and by its cross terms per unit of block-fading
  // power.
  double own = 0, cross_terms = 0;
  std::vector<FadingTerm> terms;
};

// Statistics of `paths`, which are sorted by delay, over `band`.
EqualizerStatistics equalizer_statistics(const std::vector<EqualizerPath>& paths, const Band& band);

}  // namespace halocline::acoustics
