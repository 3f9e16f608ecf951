// SPDX-License-Identifier: BSD-3-Clause
// Level, delay spread and impulse response at a receiver from the paths of a link.
//
// Model: pressures add. By default they add incoherently, as powers: the mean over any small change of
// position (at 25 kHz a centimetre moves the coherent level by 3 dB). Coherently they add as phasors at one
// frequency, for the exact positions of the ends. Both include spreading, bounces and absorption. A beam
// pattern weights each path by the angle at which it leaves or arrives.
//
// Levels are relative to the source level: dB, never positive in practice; transmission loss is their
// negative. Without a path the level is -infinity dB, see PathLack in acoustics/rays/eigenray.h; the caller
// may set a floor. The impulse response is that of the complex envelope about the carrier: one tap a path,
// without the modem's own filter.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/eigenray.h"
#include "core/units.h"

namespace halocline::acoustics {

// Transducers at both ends; omnidirectional unless given.
struct Transducers {
  BeamPattern source, receiver;
};

// Pressure of one path relative to that at 1 m, with absorption and beams.
double weighted_pressure(const Eigenray& path, const Transducers& transducers);

// Options of the level.
struct FieldOptions {
  Transducers transducers;
  // Least level reported, for shadows that diffraction and scattering are expected to fill. Empty: a shadow
  // has the level -infinity.
  std::optional<Decibels> floor;
};

// Level and delays of all paths together.
struct ReceivedField {
  bool silent = true;         // there is no path
  Decibels level{-1e300};     // sum of powers, dB re the source level
  double first_delay_s = 0;   // delay of the first path; 0 when silent
  double mean_delay_s = 0;    // weighted by power
  double delay_spread_s = 0;  // rms about that mean, weighted by power
  double longest_echo_s = 0;  // delay from the first to the last path within 30 dB of the strongest
};
ReceivedField received_field(const Eigenrays& eigenrays, const FieldOptions& options = {});

// Level of the sum of phasors at `frequency_hz` plus the power of diffuse paths, dB re the source level;
// absorption is that at RayOptions::frequency_hz.
Decibels coherent_level(const Eigenrays& eigenrays, double frequency_hz, const FieldOptions& options = {});

// Taps of the complex envelope about `carrier_hz`, `count` samples at `rate_hz` from `from_s` on. Each path
// is added to its nearest sample with the phase of its own delay. Paths outside of the samples, and diffuse
// ones, are left out. rate_hz in (0, 1e7], count 1..1e7.
std::vector<std::complex<double>> impulse_response(const Eigenrays& eigenrays, double carrier_hz,
                                                   double rate_hz, double from_s, std::size_t count,
                                                   const Transducers& transducers = {});

}  // namespace halocline::acoustics
