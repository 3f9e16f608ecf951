// SPDX-License-Identifier: BSD-3-Clause
// A packet as one receiver gets it: signal and own interference over its time and band.
//
// Model, with the paths' responses h_p(t) (acoustics/fading/path_responses.h), the window's weights w_p
// (acoustics/reception/guard_window.h), excess delays tau_p and Doppler factors D_p relative to the window's
// strongest path:
//   S(t, f) = |sum_p w_p sqrt(rho_p) h_p(t) exp(-j 2 pi (f tau_p - f_c (D_p - D) t))|^2
//   I(t)    = sum_p i_p |h_p(t)|^2 while path p of the packet sounds
// at 8 frequencies, evenly over the band, in 8 to 64 stretches of the bits, each a quarter of the coherence
// time and an eighth of the bits at most, and 1 to 8 of the preamble. Phase-shift keying follows a fading
// path for T = 0.05 s (our choice): of what it scatters, rho = exp(-(2 pi B T)^2 / 2) is signal, the rest
// interferes; its equaliser collects the band, so S is the mean over all of it. Elsewhere rho = 1. Coded
// frequency-shift keying hops: its 8 frequencies move by eighths of their spacing from stretch to stretch, so
// that no delay below 64 periods of the band is in step at all of them. A Doppler shift beyond what the
// receiver corrects leaves e = (|D - 1| - correction) f_c: frequency-shift keying loses 1 - sinc^2(e T_chip)
// of the signal to the next tone, phase-shift keying 1 - exp(-(2 pi e 0.01 s)^2 / 2) (our choice).
// signal_history() is as if all were corrected; shifted_history() has the loss.
// Without fading nothing varies but which echoes sound: powers of paths add, S = sum w^2 P, at no frequency
// in particular.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/path_responses.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/guard_window.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

// Frequencies over the band at which the signal is evaluated.
inline constexpr std::size_t kSignalFrequencies = 8;

// How long preamble and bits sound at the receiver.
struct ReceivedTiming {
  double preamble_s = 0, duration_s = 0;
};

struct SignalHistory {
  std::vector<double>
      edges_s;  // of the stretches, rising, from the begin of the packet: one more than stretches
  std::size_t frequencies = 1;
  std::vector<double> signal;  // uPa^2 in the band, by stretch, then frequency
  std::vector<double> echoes;  // uPa^2, by stretch: the packet's own interference

  std::size_t stretches() const { return echoes.size(); }
  double mean_signal(std::size_t stretch) const;
};

// The receiver's modem and what it locked on, both of which outlive this.
struct Lock {
  const Modem* modem;
  const GuardWindow& window;
};

// Of a packet that begins at `begin` in the window; `band` is the packet's. `large_scale` is 10^(X/20).
SignalHistory signal_history(const PathResponses& fading, double large_scale,
                             const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                             SimTime begin, const ReceivedTiming& timing);
// By the model, or without fading where it is not enabled.
SignalHistory signal_history(const FadingModel& model, const FadingLink& link, double large_scale,
                             const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                             SimTime begin, const ReceivedTiming& timing);
// The same after a Doppler shift that leaves `share` of the signal (doppler_share()): the rest interferes.
SignalHistory shifted_history(SignalHistory history, double share);
// Without fading.
SignalHistory still_history(const std::vector<SoundPath>& paths, const Lock& lock,
                            const ReceivedTiming& timing);

// Share of the signal that a Doppler shift leaves which the receiver does not correct, 0..1.
double doppler_share(const Modem& receiver, const SoundPath& strongest, double centre_hz);
// Share of a path's power that the receiver follows as it fades: rho, 0..1.
double tracked_share(const Modem& receiver, const SoundPath& path);

// Coherence time of the window's sound by the mean Doppler spread of its paths, weighted by power, s.
double coherence_time_s(const std::vector<SoundPath>& paths, const GuardWindow& window);

}  // namespace halocline::acoustics
