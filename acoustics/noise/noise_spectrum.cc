// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/noise/noise_spectrum.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "acoustics/math/frequency_band.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {

NoiseSpectrum::NoiseSpectrum(std::vector<double> frequencies_hz, std::vector<double> levels_db)
    : frequencies_hz_(std::move(frequencies_hz)), levels_db_(std::move(levels_db)) {
  require(!frequencies_hz_.empty() && frequencies_hz_.size() == levels_db_.size(),
          "a noise spectrum needs at least one frequency, and a level for each");
  double last_hz = 0;
  for (const double f : frequencies_hz_) {
    require_in_range(f, 1, 1e6, "frequency of a noise spectrum", "Hz");
    require(f > last_hz, "the frequencies of a noise spectrum must rise");
    last_hz = f;
  }
  for (const double level : levels_db_) require_in_range(level, -200, 300, "level of a noise spectrum", "dB");
}

Decibels NoiseSpectrum::level(double frequency_hz) const {
  const auto above = std::upper_bound(frequencies_hz_.begin(), frequencies_hz_.end(), frequency_hz);
  if (above == frequencies_hz_.begin()) return {levels_db_.front()};
  if (above == frequencies_hz_.end()) return {levels_db_.back()};
  const auto i = static_cast<std::size_t>(std::distance(frequencies_hz_.begin(), above));
  const double low = frequencies_hz_[i - 1], high = frequencies_hz_[i];
  // Linear in the logarithm of the frequency.
  const double share = elementary::log10(frequency_hz / low) / elementary::log10(high / low);
  return {levels_db_[i - 1] + share * (levels_db_[i] - levels_db_[i - 1])};
}

Decibels NoiseSpectrum::least_level(double low_hz, double high_hz) const {
  Decibels least = std::min(level(low_hz), level(high_hz));
  for (std::size_t i = 0; i < frequencies_hz_.size(); ++i) {
    if (frequencies_hz_[i] > low_hz && frequencies_hz_[i] < high_hz)
      least = std::min(least, Decibels{levels_db_[i]});
  }
  return least;
}

PowerRatio NoiseSpectrum::power_over_band(double low_hz, double high_hz) const {
  double power = 0;
  for (const FrequencyNode& node : frequency_nodes(low_hz, high_hz))
    power += node.weight_hz * to_power_ratio(level(node.frequency_hz)).value;
  return {power};
}

}  // namespace halocline::acoustics
