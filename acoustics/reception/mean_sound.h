// SPDX-License-Identifier: BSD-3-Clause
// What sounds in a receiver's window on average over fading, as far as predictions need it
// (acoustics/reception/link_prediction.h): powers, their correlation over the band, and how fast they fade.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/collected_sound.h"
#include "acoustics/reception/power_law.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// At the frequencies of signal_history.h.
using BandPressures = std::array<std::complex<double>, kSignalFrequencies>;
// Of pressures B_m that fade, by k = m - n: E B_m B_n* = sum of P exp(-j 2 pi k spacing delay); [0] is their
// power.
using BandCorrelation = std::array<std::complex<double>, kSignalFrequencies>;

struct MeanSound {
  BandPressures steady{};  // A_m, constant within its part of the band (steady_band.h)
  std::array<double, kSignalFrequencies> varying{};  // power of coherent paths that varies within each part
  double sway_variance = 0;                          // relative, of the mean over the band as the ends sway
  BandCorrelation medium{};     // of what the medium turns, and of what is scattered so slowly that it holds
  CollectedSound collected;     // of phase-shift keying, in place of all those
  double spread_hz = 0;         // rms, of the latter
  double window_spread_hz = 0;  // of all in the window: it sets the stretches of signal_history.h
  double preamble_variance = 1, bits_variance = 1;  // shares of its variance that its mean over them keeps
  double untracked = 0;  // interference by what the receiver does not track, in units of the signal
  double preamble_echoes = 0, bits_echoes = 0;  // uPa^2, late ones, on average over preamble and bits
  // Late ones while they sound, `late_share` of the bits; and of those what fades beside the signal: of
  // phase-shift keying, slowly.
  double late_echoes = 0, late_share = 1, fading_echoes = 0;
  // Of those means, relative: each path fades by itself, sum p^2 (1 - c^2) kept / (sum p)^2.
  double preamble_echo_variance = 0, bits_echo_variance = 0;
  PowerLaw slow;    // the power of the band without what fades within a packet
  double fast = 0;  // mean power of what does
  double own = 0,
         beats = 0;  // variance of the fast by itself; by its beats with the slow, over the power of that

  // Of the power of the band while that is `slow_power`, by what fades within a packet: `kept` of its
  // variance.
  PowerLaw power(double slow_power, double kept) const;
};

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                     const PacketTiming& timing);

// Share of its variance that the mean over a time keeps of a power whose autocorrelation is exp(-(tau /
// L)^2), for x = time / L: 1 - x^2 / 6 of short times, sqrt(pi) / x of long ones, within 6 % between.
inline double kept_variance(double x) { return 1 / std::sqrt(1 + x * x / std::numbers::pi); }
// The same share for a power whose L is sqrt(2) times as long, and for a part of the time.
double kept_of_longer(double kept);
double kept_of_part(double kept, double part);

}  // namespace halocline::acoustics
