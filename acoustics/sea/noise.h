// SPDX-License-Identifier: BSD-3-Clause
// Ambient noise of the sea: spectrum level by source, and level over a band.
//
// Model: the four empirical components of Coates 1990 as used by Stojanovic 2006 (WUWNet) and the 2010 IEEE
// SMC paper's table III, f in kHz:
//   turbulence 17 - 30 log f;                    shipping 40 + 20 (s - 0.5) + 26 log f - 60 log(f + 0.03);
//   wind 50 + 7.5 sqrt(w) + 20 log f - 40 log(f + 0.4);  thermal -15 + 20 log f,
// dB re 1 uPa^2/Hz. The total is the sum of the linear powers, never of decibels. 10 Hz to about 1 MHz; the
// spread of measurements about it is 5 to 10 dB. Depth does not enter. Rain of R mm/h adds
//   rain 42.4 + 15.4 log R - 10 log(1 + (f / 15)^2):
// the level at 5 kHz of Ma and Nystuen 2005 (J. Atmos. Ocean. Technol. 22, 1225; 2 to 200 mm/h), white up to
// some 15 kHz and falling beyond, as the impact of drops (Nystuen 1986); that shape is our choice. A table of
// levels takes the place of all of these (noise_spectrum.h). Left out: ice, animals; vehicles:
// channel_server/vehicles/vehicle_noise.h.
#pragma once

#include <memory>

#include "acoustics/noise/noise_spectrum.h"
#include "core/units.h"

namespace halocline::acoustics {

// Sources of ambient noise.
struct NoiseSources {
  double shipping = 0.5;                                 // activity, 0 (none) to 1 (heavy)
  double wind_mps = 0;                                   // 10 m above the sea, 0 to 60
  double rain_mm_per_h = 0;                              // 0 to 500
  std::shared_ptr<const NoiseSpectrum> table = nullptr;  // instead of all others
};

// Spectrum levels, dB re 1 uPa^2/Hz; total_power in uPa^2/Hz.
struct NoiseComponents {
  Decibels turbulence, shipping, wind, thermal, rain,
      total;  // of no rain -300; of a table the total alone is its
  PowerRatio total_power;
};

// At `frequency_hz` > 0.
NoiseComponents noise_components(double frequency_hz, const NoiseSources& sources);

// The total alone: power density, uPa^2/Hz, at `frequency_hz` > 0.
PowerRatio noise_power_density(double frequency_hz, const NoiseSources& sources);

// The least density at any frequency of the band, or less.
PowerRatio least_noise_power_density(double low_hz, double high_hz, const NoiseSources& sources);

// Power over the band, uPa^2: the integral of the density from `low_hz` to `high_hz`, 0 < low_hz <= high_hz,
// to 1e-12.
PowerRatio noise_power_over_band(double low_hz, double high_hz, const NoiseSources& sources);

// The same as a level, dB re 1 uPa.
Decibels noise_level_over_band(double low_hz, double high_hz, const NoiseSources& sources);

}  // namespace halocline::acoustics
