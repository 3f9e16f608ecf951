// SPDX-License-Identifier: BSD-3-Clause
// Power of a link's coherent paths over the band, by the parts of it in which a signal of frequency-shift
// keying is evaluated (signal_history.h).
//
// Model: paths whose delays differ by d interfere with a period of 1 / d over the band. Each part is sampled
// at places apart by no more than half of 1 / (guard time + taper), so that no two paths in the window seem
// to be in step at all of them, nor the squares of their power. Of a part's mean power S and its variance V
// over the samples,
//   constant = sqrt(S^2 - V), varying = S - constant
// are those of a steady and a diffuse signal (Rice 1945) of the same S and V. Both follow the delays, not the
// phases, of paths that interfere many times over a part: a vehicle that moves by a wavelength does not
// change them. Paths that interfere less than kNearCycles times over the band do change with it, by their
// angles. Both ends sway up and down by kSwayM rms (our choice) from packet to packet, so that the
// interference of two paths p, q is
//   g = exp(-(k kSwayM)^2 ((sin launch_p - sin launch_q)^2 + (sin arrival_p - sin arrival_q)^2) / 2)
// of what it is where the ends are, and 2 a_p a_q cos(phase) sinc(cycles) varies by
//   4 a_p^2 a_q^2 sinc(cycles)^2 (1 - g^2) (1 - g^2 cos(2 phase)) / 2.
// The parts lose the same: interference that comes and goes over the band sway moves only from part to part.
// Close paths, as of a buoy just below the surface and far away, keep g near 1: Lloyd's mirror stays.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

inline constexpr double kSwayM = 0.2, kNearCycles = 4;

// exp(j 2 pi m turns), m = 0..7; of half a turn, exp(j pi turns).
struct BandTurns {
  std::array<double, kSignalFrequencies> re{}, im{};
  std::complex<double> half;
};
BandTurns band_turns(double turns);

class SteadyBand {
 public:
  struct Part {
    double constant = 0, varying = 0;  // of the power, uPa^2
  };

  SteadyBand(const Modem& receiver, const Band& band, std::size_t paths = 0);  // about so many are added
  struct Path {
    double pressure = 0, phase_rad = 0,
           excess_s = 0;  // phase at the band's low end; delay after that of the reference
    double launch_sine = 0, arrival_sine = 0;
  };

  // By path, for its pairs: pressure at the middle of the band, half of its turn over the band with sine and
  // cosine.
  struct Member {
    double re, im, half, sine, cosine, launch_sine, arrival_sine, pressure;
  };

  // By rising delay.
  void add(const Path& path) { add(path, band_turns(-part_hz_ * path.excess_s)); }
  // The same, with the turns of its phase from part to part. Returns its pressure at the middle of the
  // lowest.
  std::complex<double> add(const Path& path, const BandTurns& turns);
  // From low to high.
  std::array<Part, kSignalFrequencies> parts() const { return parts(sway()); }
  // Variance of the mean over the band as the ends sway, uPa^4.
  double sway_variance() const { return sway().variance; }

  // Of the mean over the band: what sway adds to it, and its variance by sway. All pairs of paths are looked
  // at once.
  struct Sway {
    double change = 0, variance = 0;
  };
  Sway sway() const;
  std::array<Part, kSignalFrequencies> parts(const Sway& sway) const;

 private:
  static constexpr std::size_t kMaxSamples = 32;  // of a part

  static void add(const Sway& sway, std::array<Part, kSignalFrequencies>& parts);

  Band band_;
  double part_hz_;
  std::size_t samples_;
  using Samples = std::array<std::array<double, kSignalFrequencies>, kMaxSamples>;
  Samples re_{}, im_{};  // by sample, then part
  std::vector<Member> members_;
};

}  // namespace halocline::acoustics
