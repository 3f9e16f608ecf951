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
#include "acoustics/reception/power_law.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// At the frequencies of signal_history.h.
using BandPressures = std::array<std::complex<double>, kSignalFrequencies>;
// Of pressures B_m that fade, by k = m - n: E B_m B_n* = sum of P exp(-j 2 pi k spacing delay); [0] is their power.
using BandCorrelation = std::array<std::complex<double>, kSignalFrequencies>;

// Sums over paths of products of what they scatter within a packet: x as signal, y as interference, uPa^2.
struct SharedFading {
  double own = 0;  // variance of the signal's mean over the band
  double y = 0, xy = 0, yy = 0;
  double xy_spread = 0, yy_spread = 0;  // times the squared spread of the path, Hz^2
};

// Independent parts of the sound of the band that is scattered within a packet: eigenvectors of its correlation.
struct BandMode {
  double scattered = 0;     // its mean power
  double interference = 0;  // of the interference, what fades with it
  double rest = 0;          // of the power that does not fade within a packet, what beats with it
};

struct MeanSound {
  BandPressures steady{};  // A_m, constant within its part of the band (steady_band.h)
  std::array<double, kSignalFrequencies> varying{};  // power of coherent paths that varies within each part
  double sway_variance = 0;                          // relative, of the mean over the band as the ends sway
  BandCorrelation medium{};     // of what the medium turns, and of what is scattered so slowly that it holds
  BandCorrelation scattered{};  // of what fades within a packet
  // Of that what beats with A_m: its mean over a part, the less the later or earlier than the strongest path it arrives.
  BandCorrelation beating{};
  double spread_hz = 0;         // rms, of the latter
  double window_spread_hz = 0;  // of all in the window: it sets the stretches of signal_history.h
  double preamble_variance = 1, bits_variance = 1;  // shares of its variance that its mean over them keeps
  double untracked = 0;  // interference by what the receiver does not track, in units of the signal
  double preamble_echoes = 0, bits_echoes = 0;  // uPa^2, late ones, on average over preamble and bits
  // Of those means, relative: each path fades by itself, sum p^2 (1 - c^2) kept / (sum p)^2.
  double preamble_echo_variance = 0, bits_echo_variance = 0;
  double beats =
      0;  // variance by beats of what fades within a packet with the rest, over the power of the rest
  SharedFading shared;
  std::vector<BandMode> modes;  // of what is scattered within a packet
  double apart = 0;             // of the interference that fades within a packet, what fades in no mode

  double scattered_power() const { return scattered[0].real(); }
  double coherent_power() const;  // mean over the band
  // The power of the band without what fades within a packet.
  PowerLaw slow_power() const;
  // Of the power of the band while that is `slow_power`, by what fades within a packet: `kept` of its variance.
  PowerLaw power(double slow_power, double kept) const;
};

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                     const PacketTiming& timing);

// Share of its variance that the mean over a time keeps of a power whose autocorrelation is exp(-(tau / L)^2), for
// x = time / L: 1 - x^2 / 6 of short times, sqrt(pi) / x of long ones, within 6 % between.
double kept_variance(double x);
// The same share for a power whose L is sqrt(2) times as long, and for a part of the time.
double kept_of_longer(double kept);
double kept_of_part(double kept, double part);
// The same of the third cumulant: of two unequal parts, or of many equal ones.
double third_share(double kept);

// Powers while the medium holds in one state, by frequency.
struct SlowSound {
  std::array<double, kSignalFrequencies> steady{}, varying{};
  double slow_power = 0;  // without what fades within a packet, over the band

  void scale(double factor);
};

// States of the medium: pressures that have its correlation, from complex normals of variance 1.
class MediumStates {
 public:
  explicit MediumStates(const MeanSound& sound);
  SlowSound state(const BandPressures& normals) const;

 private:
  const MeanSound& sound_;
  std::array<BandPressures, kSignalFrequencies> rows_{};  // of the lower triangular root of the correlation
};

}  // namespace halocline::acoustics
