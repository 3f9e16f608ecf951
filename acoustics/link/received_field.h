// SPDX-License-Identifier: BSD-3-Clause
// Level, delay spread and impulse response at a receiver from the paths of a link.
//
// Model: pressures add. Incoherently their powers add, which is the mean over any small change of place (at
// 25 kHz a centimetre moves the coherent level by 3 dB): the default. Coherently they add as phasors at one
// frequency, for the ends exactly where they are. Both with spreading, bounces and absorption. A beam pattern
// weighs each path by the angle in which it leaves or arrives.
//
// Levels are relative to the source level: dB, never positive in practice; transmission loss is their
// negative. No path is -infinity dB, see PathLack in acoustics/rays/arrivals.h; a floor is the caller's to
// state. The impulse response is that of the carrier's complex envelope: a tap per path, none of the modem's
// own filter.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/arrivals.h"
#include "core/units.h"

namespace halocline::acoustics {

// Transducers at both ends; omnidirectional unless given.
struct Transducers {
  BeamPattern source, receiver;
};

// Pressure of one path relative to that at 1 m, absorption and beams in it.
double weighted_pressure(const Arrival& path, const Transducers& transducers);

struct FieldOptions {
  Transducers transducers;
  // Least level reported, where diffraction and scattering are expected to fill shadows. Empty: a shadow is
  // -infinity.
  std::optional<Decibels> floor;
};

// Level and delays of all paths together.
struct ReceivedField {
  bool silent = true;         // no path at all
  Decibels level{-1e300};     // sum of powers, dB re the source level
  double first_delay_s = 0;   // of the first path; 0 without one
  double mean_delay_s = 0;    // weighted by power
  double delay_spread_s = 0;  // rms about that mean, weighted by power
  double longest_echo_s = 0;  // last path within 30 dB of the strongest, after the first of those
};
ReceivedField received_field(const Arrivals& arrivals, const FieldOptions& options = {});

// Level of the phasor sum at `frequency_hz`, and of the power of what is diffuse, dB re the source level;
// absorption as found at RayOptions::frequency_hz.
Decibels coherent_level(const Arrivals& arrivals, double frequency_hz, const FieldOptions& options = {});

// Taps of the complex envelope about `carrier_hz`, sampled at `rate_hz` from `from_s` on, `count` of them:
// each path falls on its nearest sample with the phase of its own delay. Paths outside, and diffuse ones, are
// left out. rate_hz in (0, 1e7], count 1..1e7.
std::vector<std::complex<double>> impulse_response(const Arrivals& arrivals, double carrier_hz,
                                                   double rate_hz, double from_s, std::size_t count,
                                                   const Transducers& transducers = {});

}  // namespace halocline::acoustics
