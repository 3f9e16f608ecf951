// SPDX-License-Identifier: BSD-3-Clause
// Statistics over fading of the signal and the interference in a receiver's window, for predictions
// (acoustics/prediction/link_prediction.h): powers, their correlation over the band, and the speed of their
// fading.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/prediction/equalizer_statistics.h"
#include "acoustics/prediction/gamma_power.h"
#include "acoustics/reception/disturbing_powers.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// Complex pressures at the frequencies of signal_history.h.
using BandPressures = std::array<std::complex<double>, kSignalFrequencies>;
// Frequency correlation of fading pressures B_m over the lag k = m - n:
//   E B_m B_n* = sum over paths of  P exp(-j 2 pi k spacing delay);
// element 0 is their power.
using BandCorrelation = std::array<std::complex<double>, kSignalFrequencies>;

// Statistics of reception at one receiver. Signal and interference powers are in uPa^2 over the band.
struct ReceptionStatistics {
  BandPressures steady{};  // A_m, constant within part m of the band (steady_band.h)
  std::array<double, kSignalFrequencies> varying{};  // power of coherent paths that varies within each part
  double jitter_variance = 0;  // relative variance of the mean over the band by platform jitter
  // Correlation of the part that the medium turns and of scattering so slow that it stays constant through a
  // packet.
  BandCorrelation medium{};
  EqualizerStatistics equalizer;  // phase-shift keying: replaces all members above
  double spread_hz = 0;           // Doppler spread of the power that fades within a packet, rms
  // Doppler spread of all paths in the window, rms; it sets the stretches of signal_history.h.
  double window_spread_hz = 0;
  // Variance reduction: shares of the variance of the fast-fading power that remain in its mean over the
  // preamble and over the bits.
  double preamble_variance = 1, bits_variance = 1;
  // Signal lost to Doppler and untracked fading, which interferes; relative to the signal.
  double untracked = 0;
  double preamble_echoes = 0, bits_echoes = 0;  // late echoes, mean over the preamble and over the bits
  // Late echoes while they are present, which is `late_share` of the bits, and the part of them that fades
  // independently of the signal: in phase-shift keying the block-fading part.
  double late_echoes = 0, late_share = 1, fading_echoes = 0;
  // Relative variances of the echo powers of preamble and bits, each path fading independently, c its
  // coherent share:
  //   sum p^2 (1 - c^2) kept / (sum p)^2.
  double preamble_echo_variance = 0, bits_echo_variance = 0;
  GammaPower block_fading;  // the power over the band without the part that fades within a packet
  double fast = 0;          // mean power that fades within a packet
  // Variance of the fast-fading power by itself, uPa^4, and by its cross terms per unit of block-fading
  // power.
  double own = 0, cross_terms = 0;

  // Distribution of the power over the band while the block-fading power is `block_power`; averaging leaves
  // the share `kept` of the variance of the fast-fading power.
  GammaPower power(double block_power, double kept) const;
};

// Statistics of `paths` for the receiver's window `sync` and a packet of the given band and timing. `paths`
// are not empty. Interference is per hydrophone of the receiver: divided by their number, as
//   SINR = n S / (N + I) = S / (N / n + I / n).
ReceptionStatistics reception_statistics(const std::vector<Arrival>& paths, const Synchronisation& sync,
                                         const Band& band, const PacketTiming& timing);

// Ratio of the mean signal to noise and mean interference, and the powers that disturb over that signal;
// `noise` over the band, uPa^2, for one hydrophone of all (noise_factor() of acoustics/modem/modem.h).
double sinr_of(const ReceptionStatistics& sound, double noise);
DisturbingPowers disturbances_of(const ReceptionStatistics& sound, double noise);

// Variance reduction by averaging over a time T: the share of the variance that remains in the mean of a
// power with the autocorrelation
//   exp(-(tau / L)^2),
// as a function of x = T / L. It is 1 - x^2 / 6 for short times and sqrt(pi) / x for long ones, within 6 % in
// between.
inline double variance_reduction(double x) { return 1 / std::sqrt(1 + x * x / std::numbers::pi); }
// variance_reduction() from its value `kept` for the time T: for a power whose L is sqrt(2) times as long,
// and for the mean over `part` of the time.
double reduction_of_longer(double kept);
double reduction_of_part(double kept, double part);

// Delay spread about the mean delay, weighted by power, s rms; 0 when there is no path.
double rms_delay_spread_s(const std::vector<Arrival>& paths);

}  // namespace halocline::acoustics
