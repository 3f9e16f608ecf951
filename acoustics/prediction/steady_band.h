// SPDX-License-Identifier: BSD-3-Clause
// Power of a link's coherent paths over the band, by the parts of the band in which a signal of
// frequency-shift keying is evaluated (signal_history.h).
//
// Model: two paths whose delays differ by d interfere with the period 1 / d over frequency. Each part is
// sampled at intervals of at most half of 1 / (guard time + taper), so that no two paths in the window, nor
// the squares of their power, are aliased to a constant phase at all samples. A part of mean power S and
// variance V over the samples has
//   constant = sqrt(S^2 - V),  varying = S - constant:
// the steady and the diffuse part of a signal (Rice 1945) of the same S and V. For paths that interfere many
// times over a part both follow the delays, not the phases: they do not change when a vehicle moves by a
// wavelength. Paths that interfere less than kNearCycles times over the band do change, by their angles. Both
// ends move vertically by kPlatformJitterM rms from packet to packet: platform jitter (platform_jitter.h). It
// reduces the mean interference of two paths by the factor g relative to its value at the given positions.
// All parts lose the same, since jitter moves interference that alternates over the band only between parts.
// Close paths, such as those of a distant buoy just below the surface, keep g near 1: Lloyd's mirror is
// preserved.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// Number of interference cycles over the band below which a pair of paths counts as near.
inline constexpr double kNearCycles = 4;

// Phase factors exp(j 2 pi m turns), m = 0..7, and that of half a turn, exp(j pi turns).
struct BandTurns {
  std::array<double, kSignalFrequencies> re{}, im{};
  std::complex<double> half;
};
BandTurns band_turns(double turns);

// Accumulates the coherent paths of a link and returns the power in each part of the band.
class SteadyBand {
 public:
  struct Part {
    double constant = 0, varying = 0;  // components of the power, uPa^2
  };

  SteadyBand(const Modem& receiver, const Band& band, std::size_t paths = 0);  // reserves room for `paths`
  // A coherent path. The phase is that at the low end of the band, the excess delay that after the reference
  // path; the sines are those of the launch and arrival angles.
  struct Path {
    double pressure = 0, phase_rad = 0, excess_s = 0;
    double launch_sine = 0, arrival_sine = 0;
  };

  // A path prepared for pairing: its pressure at the middle of the band, half of its phase change over the
  // band with the sine and cosine of it.
  struct Member {
    double re, im, half, sine, cosine, launch_sine, arrival_sine, pressure;
  };

  // Adds a path; call in order of ascending delay.
  void add(const Path& path) { add(path, band_turns(-part_hz_ * path.excess_s)); }
  // Adds a path whose phase factors from part to part are known. Returns its pressure at the middle of the
  // lowest part.
  std::complex<double> add(const Path& path, const BandTurns& turns);
  // Powers of the parts, from the low end of the band to the high.
  std::array<Part, kSignalFrequencies> parts() const { return parts(jitter()); }
  // Variance of the mean power over the band by platform jitter, uPa^4.
  double jitter_variance() const { return jitter().variance; }

  // Effect of platform jitter on the mean power over the band: the change of the mean, uPa^2, and the
  // variance, uPa^4. All pairs of paths are evaluated in one pass.
  struct JitterEffect {
    double change = 0, variance = 0;
  };
  JitterEffect jitter() const;
  std::array<Part, kSignalFrequencies> parts(const JitterEffect& jitter) const;

 private:
  static constexpr std::size_t kMaxSamples = 32;  // samples in a part

  static void add(const JitterEffect& jitter, std::array<Part, kSignalFrequencies>& parts);

  Band band_;
  double part_hz_;
  std::size_t samples_;
  using Samples = std::array<std::array<double, kSignalFrequencies>, kMaxSamples>;
  Samples re_{}, im_{};  // [sample][part]
  std::vector<Member> members_;
};

}  // namespace halocline::acoustics
