// SPDX-License-Identifier: BSD-3-Clause
// What an equaliser that collects the band makes of the paths in its window, on average over fading:
// phase-shift keying.
//
// Model: S = sum over pairs of paths p, q of sqrt(x_p x_q) Re(h_p h_q* exp(-j 2 pi f_c tau)) sinc(W tau), tau
// the difference of their delays, W the band, |h|^2 = 1 on average (signal_history.h). A path is steady,
// turned by the medium, or scattered; what is scattered so slowly that it holds through a packet counts as
// turned.
// - Slow, for a packet: steady and turned. Pairs less than kNearCycles apart over the band count, the medium
//   that they share (acoustics/fading/link_fading.h) with them. Both ends sway up and down by kSwayM rms (our
//   choice) from packet to packet, so that the interference of two paths is
//     g = exp(-(k kSwayM)^2 ((sin launch_p - sin launch_q)^2 + (sin arrival_p - sin arrival_q)^2) / 2)
//   of what it is where the ends are, and 2 a cos(phase) varies by 4 a^2 (1 - g^2) (1 - g^2 cos(2 phase)) /
//   2.
// - Fast: S varies by sum of x_p s_p x_q s_q sinc^2, and by its beats with the slow.
#pragma once

#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/reception/power_law.h"

namespace halocline::acoustics {

// A path in the window or after it. Shares add to 1.
struct CollectedPath {
  double signal = 0, interference = 0;  // mean powers, uPa^2
  double steady = 1, turned = 0, scattered = 0;
  double delay_s = 0, phase_rad = 0;  // phase at the centre of the band, of its delay, too
  double launch_angle_rad = 0, arrival_angle_rad = 0;
  double spread_hz = 0;
};

// What one path scatters within a packet.
struct FadingTerm {
  double signal = 0, interference = 0;  // uPa^2
  double unit = 0;  // of the signal, with that of paths near it that it fades with: `signal` or more
  double signal_beats = 0, interference_beats = 0;  // slow power that beats with it
  double squared_spread = 0;                        // Hz^2
};

struct CollectedSound {
  PowerLaw slow;
  double fast = 0;  // mean power
  double own = 0,
         beats = 0;  // variance of the fast by itself; by its beats with the slow, over the power of that
  std::vector<FadingTerm> terms;
};

// `paths` by delay.
CollectedSound collected_sound(const std::vector<CollectedPath>& paths, const Band& band);

}  // namespace halocline::acoustics
