// SPDX-License-Identifier: BSD-3-Clause
// A noise spectrum as a table: spectrum level by frequency, of the sea or of a vehicle.
//
// Between two frequencies the level is linear in the logarithm of frequency, dB re 1 uPa^2/Hz; beyond the
// first and the last it is theirs. A value.
#pragma once

#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

class NoiseSpectrum {
 public:
  // As many of each, at least one; frequencies rise, 1 to 1e6 Hz; levels -200 to 300 dB re 1 uPa^2/Hz (at 1 m
  // of a vehicle). Throws InvalidArgument otherwise.
  NoiseSpectrum(std::vector<double> frequencies_hz, std::vector<double> levels_db);

  Decibels level(double frequency_hz) const;
  // Of all frequencies from `low_hz` to `high_hz`.
  Decibels least_level(double low_hz, double high_hz) const;
  // Power over the band, uPa^2: the integral of the density, as acoustics::noise_power_over_band.
  PowerRatio power_over_band(double low_hz, double high_hz) const;

  const std::vector<double>& frequencies_hz() const { return frequencies_hz_; }
  const std::vector<double>& levels_db() const { return levels_db_; }
  bool operator==(const NoiseSpectrum&) const = default;

 private:
  std::vector<double> frequencies_hz_, levels_db_;
};

}  // namespace halocline::acoustics
