// SPDX-License-Identifier: BSD-3-Clause
// Signal and own interference of a packet at one receiver, over its time and band.
//
// Model, with the paths' responses h_p(t) (acoustics/fading/path_responses.h), the weights w_p of the window
// (acoustics/reception/guard_window.h), interference shares i_p, excess delays tau_p and Doppler factors D_p,
// and D the Doppler factor of the strongest path in the window, to which tau_p is relative:
//   S(t, f) = |sum_p w_p sqrt(rho_p) h_p(t) exp(-j 2 pi (f tau_p - f_c (D_p - D) t))|^2
//   I(t)    = sum_p i_p |h_p(t)|^2  over the paths p on which the packet is present at t
// Grid: 8 frequencies, evenly over the band; 8 to 64 stretches of the bits, each at most a quarter of the
// coherence time and an eighth of the bits; 1 to 8 stretches of the preamble.
// - An equaliser (ReceiverKind) of phase-shift keying tracks a path for T = 0.05 s (our choice). The share
//     rho = exp(-(2 pi B T)^2 / 2)
//   of its power is signal, the rest interferes: fast fading. Its equaliser combines the band, so S is the
//   mean over the band. For other modems rho = 1.
// - Coded frequency-shift keying hops: its 8 frequencies move by eighths of their spacing from stretch to
//   stretch, so that no delay below 64 periods of the band is in phase at all of them.
// - A Doppler shift beyond what the receiver corrects leaves e = (|D - 1| - correction) f_c and costs the
//   share
//     1 - sinc^2(e T_chip)                 of the signal, to the next tone: frequency-shift keying
//     1 - exp(-(2 pi e 0.01 s)^2 / 2)      of the signal (our choice): phase-shift keying.
//   signal_history() assumes that all of it is corrected; shifted_history() applies the loss.
// - Without fading only the set of echoes present varies: powers of paths add, S = sum w^2 P, independent of
//   frequency.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/path_responses.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/guard_window.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

// Number of frequencies over the band at which the signal is evaluated.
inline constexpr std::size_t kSignalFrequencies = 8;

// Durations of the preamble and of the whole packet at the receiver.
struct ReceivedTiming {
  double preamble_s = 0, duration_s = 0;
};

// Signal and echo powers of one packet by stretch.
struct SignalHistory {
  // Ascending edges of the stretches, from the begin of the packet: one more than there are stretches.
  std::vector<double> edges_s;
  std::size_t frequencies = 1;
  std::vector<double> signal;  // uPa^2 in the band, index stretch * frequencies + frequency
  std::vector<double> echoes;  // uPa^2 by stretch: interference by the packet's own paths
  // Part of the echoes by paths in the window: what the receiver does not track of them as they fade, and
  // what a Doppler shift that it does not correct costs.
  std::vector<double> fast_fading = {};
  // The receiver's factor on noise, 10^(receiver_loss / 10), and its hydrophones n: with interference I
  //   SINR = n S / (noise_loss N + I).
  struct ReceiverTerms {
    double noise_loss = 1, channels = 1;
  };
  ReceiverTerms receiver = {};

  std::size_t stretches() const { return echoes.size(); }
  double mean_signal(std::size_t stretch) const;
};

// The receiver's modem and the window to which it is synchronised; both must outlive this.
struct Synchronisation {
  const Modem* modem;
  const GuardWindow& window;
};

// History of a packet of the given `band` that begins at `begin` in the window. `large_scale` is 10^(X/20), X
// the large-scale fading of the link in dB.
SignalHistory signal_history(const PathResponses& fading, double large_scale,
                             const std::vector<Arrival>& paths, const Synchronisation& sync, const Band& band,
                             SimTime begin, const ReceivedTiming& timing);
// Generates the responses from the fading model; without fading when the model is not enabled.
SignalHistory signal_history(const FadingModel& model, const FadingLink& link, double large_scale,
                             const std::vector<Arrival>& paths, const Synchronisation& sync, const Band& band,
                             SimTime begin, const ReceivedTiming& timing);
// The history after an uncorrected Doppler shift that leaves `share` of the signal (doppler_share()): the
// rest interferes.
SignalHistory shifted_history(SignalHistory history, double share);
// The history of a packet when nothing fades.
SignalHistory still_history(const std::vector<Arrival>& paths, const Synchronisation& sync,
                            const ReceivedTiming& timing);

// Share of the signal that remains after a Doppler shift which the receiver does not correct, 0..1.
double doppler_share(const Modem& receiver, const Arrival& strongest, double centre_hz);
// Share of a path's power that the receiver tracks as it fades: rho, 0..1.
double tracked_share(const Modem& receiver, const Arrival& path);

// Coherence time of the signal in the window from the Doppler spread of its paths, rms weighted by power, s.
double coherence_time_s(const std::vector<Arrival>& paths, const GuardWindow& window);

}  // namespace halocline::acoustics
