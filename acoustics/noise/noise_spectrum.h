// SPDX-License-Identifier: BSD-3-Clause
// A noise spectrum as a table of spectrum level by frequency, of the sea or of a vehicle.
//
// Between two frequencies the level, dB re 1 uPa^2/Hz, is linear in the logarithm of the frequency. Beyond
// the first and the last frequency it is constant. Thread rule: a value.
#pragma once

#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

// A tabulated noise spectrum.
class NoiseSpectrum {
 public:
  // Frequencies rise within 1 to 1e6 Hz; levels lie within -200 to 300 dB re 1 uPa^2/Hz (at 1 m for a
  // vehicle). Both have the same number of entries, at least one. Throws InvalidArgument otherwise.
  NoiseSpectrum(std::vector<double> frequencies_hz, std::vector<double> levels_db);

  // Spectrum level at a frequency, dB re 1 uPa^2/Hz.
  Decibels level(double frequency_hz) const;
  // Lowest level at any frequency from `low_hz` to `high_hz`, dB re 1 uPa^2/Hz.
  Decibels least_level(double low_hz, double high_hz) const;
  // Power over the band, uPa^2: the integral of the spectral density, as acoustics::noise_power_over_band.
  PowerRatio power_over_band(double low_hz, double high_hz) const;

  const std::vector<double>& frequencies_hz() const { return frequencies_hz_; }
  const std::vector<double>& levels_db() const { return levels_db_; }
  bool operator==(const NoiseSpectrum&) const = default;

 private:
  std::vector<double> frequencies_hz_, levels_db_;
};

}  // namespace halocline::acoustics
