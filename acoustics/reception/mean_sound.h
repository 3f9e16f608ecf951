// What sounds in a receiver's window on average over fading, as far as predictions need it
// (acoustics/reception/link_prediction.h): powers, their correlation over the band, and how fast they fade.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// At the frequencies of signal_history.h.
using BandPressures = std::array<std::complex<double>, kSignalFrequencies>;
// Of pressures B_m that fade, by k = m - n: E B_m B_n* = sum of P exp(-j 2 pi k spacing delay); [0] is their power.
using BandCorrelation = std::array<std::complex<double>, kSignalFrequencies>;

struct MeanSound {
  BandPressures steady{};  // A_m, constant within its part of the band (steady_band.h)
  std::array<double, kSignalFrequencies> varying{};  // power of coherent paths that varies within each part
  double sway_variance = 0;                          // relative, of the mean over the band as the ends sway
  BandCorrelation medium{};     // of what the medium turns, and of what is scattered so slowly that it holds
  BandCorrelation scattered{};  // of what fades within a packet
  // Of that what beats with A_m: its mean over a part, the less the later or earlier than the strongest path it arrives.
  BandCorrelation beating{};
  double spread_hz = 0;                             // rms, of the latter
  double preamble_variance = 1, bits_variance = 1;  // shares of its variance that its mean over them keeps
  // Interference by what the receiver does not track, in units of the signal; its covariance with the signal and its
  // variance, relative to the signal's.
  double untracked = 0, shared_fading = 0, own_fading = 0;
  double preamble_echoes = 0, bits_echoes = 0;  // uPa^2, late ones, on average over preamble and bits

  double scattered_power() const { return scattered[0].real(); }
  // The medium's pressures that change the power most, K A / sqrt(A^H K A); none without either.
  BandPressures medium_direction() const;
};

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                     const PacketTiming& timing);

// Share of its variance that the mean over a time keeps of a power whose autocorrelation is exp(-(tau / L)^2), for
// x = time / L: 1 - x^2 / 6 of short times, sqrt(pi) / x of long ones, within 6 % between.
double kept_variance(double x);
// The same share for a power whose L is sqrt(2) times as long, and for a part of the time.
double kept_of_longer(double kept);
double kept_of_part(double kept, double part);

// Powers while the medium holds in one state.
struct SlowSound {
  std::array<double, kSignalFrequencies> steady{}, diffuse{};  // by frequency
  double mean = 0;                                             // of all, over the band
  // Variance of the mean over the band by what is scattered: alone, and with the steady part.
  double own = 0, mixed = 0;
  double constant = 0;  // of the mean: paths so far apart from those that scatter that both do not beat
};

// `state`: complex normal along `direction`; the rest of the medium is diffuse.
SlowSound slow_sound(const MeanSound& sound, const BandPressures& direction, std::complex<double> state);

}  // namespace halocline::acoustics
