// SPDX-License-Identifier: BSD-3-Clause
// Synchronisation of a receiver: the guard interval of greatest power, as a matched filter finds it.
//
// Model: the window begins at one of the paths and lasts the guard time. The pressure of a path that arrives
// d after its begin has the weight
//   w = 1                                          0 <= d <= guard
//   w = (1 + cos(pi (d - guard) / taper)) / 2      guard < d < guard + taper
//   w = 0                                          otherwise.
// The window is the one of the greatest sum of w^2 P, the earliest among equals. Of the remaining share
// 1 - w^2 of a path's power
//   kappa (1 - eta rho) (1 - w^2)
// interferes with later symbols of the packet: kappa = Modem::late_echo_share, eta = Modem::echo_cancelled,
// rho the share of the path that the receiver tracks as it fades (tracked_share() of signal_history.h). In
// frequency-hopped FSK the remainder falls on other tones: it causes no interference until the hop pattern
// returns (the clearing time). From then on a chip of the echo lies on the pair of tones that is listened to
// 1 time in N, N the number of tone pairs, with all its power in one tone of width 1 / T, T the chip. As
// white noise over the band B that is
//   B T / (2 N)
// of the echo's power (1 for JANUS); the transition takes one more chip, as a raised cosine. An echo that is
// d < T late also cuts off a chip's end: its tone leaks into the other tone of the pair, sin^2(pi n d / T) /
// (pi n)^2 of its power (correlation of a part d of the chip with a tone n / T away), as white noise over the
// band
//   B T sin^2(pi n d / T) / (pi n)^2,  n the whole number nearest to B T / (2 N), at least 1
// (JANUS 1, tones 160 Hz apart; Micromodem 2, 320 Hz) of the share 1 - w^2. (Leakage of a path within the
// window fades as the signal does and is left out.)
// Against 100 JANUS packets summed chip by chip and tone by tone over an exponential profile of 31 ms, the
// interference is 1.2 dB too little and the signal 0.8 dB too much. A receiver of the strongest path has a
// window of the resolution of its band, Modem::window_s.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// Contribution of one path to signal and interference for a given window.
struct WindowShare {
  double weight = 0;        // weight of its pressure in the signal, 0..1
  double interference = 0;  // white noise over the band, as a share of its power, >= 0
};

// A guard window and the weights of the paths in it.
struct GuardWindow {
  std::size_t first = 0;            // index of the path at which the window begins
  std::size_t strongest = 0;        // index of the path of greatest weighted power
  std::vector<WindowShare> shares;  // one for each path
};

// Mean powers of the paths, uPa^2, within 1e-9.
std::vector<double> mean_powers(const std::vector<Arrival>& paths);

// Removes paths more than 60 dB below the strongest, which have no effect. Returns `paths` itself, which must
// not be empty, or `heard`, filled with the paths that remain.
const std::vector<Arrival>& without_faint(const std::vector<Arrival>& paths, std::vector<Arrival>& heard);

// The window of the greatest power. `paths` are sorted by delay and not empty.
GuardWindow best_window(const std::vector<Arrival>& paths, const Modem& modem);

// A window that the receiver may choose, with its probability, for predictions: as paths fade, one or the
// other of two windows of similar power is the stronger. Besides the best window at most one is considered,
// the best of those without its strongest path. If its power is lower by d < 1 dB, it is chosen with the
// probability (1 - d / 1 dB)^2 / 2 (our choice), so that a small change of power never exchanges the two
// abruptly.
struct LikelyWindow {
  GuardWindow window;
  double probability = 1;
};

// The likely windows, the best first. `paths` as for best_window().
std::vector<LikelyWindow> likely_windows(const std::vector<Arrival>& paths, const Modem& modem);

// Mean signal power of a window, the sum of w^2 P, uPa^2.
double mean_signal(const std::vector<Arrival>& paths, const GuardWindow& window);

}  // namespace halocline::acoustics
