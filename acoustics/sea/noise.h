// SPDX-License-Identifier: BSD-3-Clause
// Ambient noise of the sea: spectrum level of each source, and level over a band.
//
// Model: the four empirical components of Coates 1990 as used by Stojanovic 2006 (WUWNet) and in table III of
// the 2010 IEEE SMC paper, dB re 1 uPa^2/Hz, with f in kHz, s the shipping activity and w the wind in m/s:
//   turbulence  17 - 30 log10 f
//   shipping    40 + 20 (s - 0.5) + 26 log10 f - 60 log10(f + 0.03)
//   wind        50 + 7.5 sqrt(w) + 20 log10 f - 40 log10(f + 0.4)
//   thermal     -15 + 20 log10 f
// The total is the sum of powers, not of decibels. Valid from 10 Hz to about 1 MHz; measurements scatter
// about it by 5 to 10 dB. The level does not depend on depth. Rain of R mm/h adds
//   rain        42.4 + 15.4 log10 R - 10 log10(1 + (f / 15)^2),
// the level at 5 kHz of Ma and Nystuen 2005 (J. Atmos. Ocean. Technol. 22, 1225; 2 to 200 mm/h), white up to
// some 15 kHz and falling above, as for the impact of drops (Nystuen 1986); this spectral shape is our
// choice. A place adds its own noise in power (acoustics/noise/place_noise.h), or a spectrum measured there
// does; under fast ice it takes the place of wind. A table of levels replaces all of these
// (noise_spectrum.h). For vehicles see channel_server/vehicles/vehicle_noise.h.
#pragma once

#include <memory>

#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/noise/place_noise.h"
#include "core/units.h"

namespace halocline::acoustics {

// Sources of ambient noise.
struct NoiseSources {
  double shipping = 0.5;                                 // activity, 0 (none) to 1 (heavy)
  double wind_mps = 0;                                   // m/s, 10 m above the sea, 0 to 60
  double rain_mm_per_h = 0;                              // 0 to 500
  std::shared_ptr<const NoiseSpectrum> table = nullptr;  // replaces all other sources
  NoisePlace place = NoisePlace::kOpen;
  // Noise of the place as measured, in the place of that of its kind.
  std::shared_ptr<const NoiseSpectrum> site = nullptr;
  double offset_db = 0;  // added to the level of all of them together, such as a calibration found it
};

// Spectrum levels, dB re 1 uPa^2/Hz, and their total power, uPa^2/Hz. A source that is absent (rain, a
// place in the open sea, wind under ice) has the level -300. A table and the offset set the total alone.
struct NoiseComponents {
  Decibels turbulence, shipping, wind, thermal, rain, place, total;
  PowerRatio total_power;
};

// Components at `frequency_hz` > 0.
NoiseComponents noise_components(double frequency_hz, const NoiseSources& sources);

// Total power density, uPa^2/Hz, at `frequency_hz` > 0.
PowerRatio noise_power_density(double frequency_hz, const NoiseSources& sources);

// Lower bound of the power density over the band, uPa^2/Hz.
PowerRatio least_noise_power_density(double low_hz, double high_hz, const NoiseSources& sources);

// Power over the band, uPa^2: the integral of the density from `low_hz` to `high_hz`, 0 < low_hz <= high_hz,
// with a relative error of 1e-12.
PowerRatio noise_power_over_band(double low_hz, double high_hz, const NoiseSources& sources);

// Noise over the band as a level, dB re 1 uPa.
Decibels noise_level_over_band(double low_hz, double high_hz, const NoiseSources& sources);

}  // namespace halocline::acoustics
