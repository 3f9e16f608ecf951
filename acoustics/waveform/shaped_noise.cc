// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/waveform/shaped_noise.h"

#include <cmath>

#include "acoustics/waveform/linear_phase_filter.h"

namespace halocline::acoustics {
ShapedNoise::ShapedNoise(const std::function<double(double)>& density, double rate_hz, DrawAddress address)
    : address_(address),
      taps_(linear_phase_taps(
          [&](double frequency_hz) { return std::sqrt(density(frequency_hz) * rate_hz / 2); }, rate_hz)) {}

std::vector<double> ShapedNoise::samples(std::int64_t first, std::size_t count,
                                         const std::function<double(std::int64_t)>& weight) const {
  std::vector<double> white(count + 2 * kFilterHalf);
  for (std::size_t i = 0; i < white.size(); ++i) {
    const std::int64_t sample = first + static_cast<std::int64_t>(i) - static_cast<std::int64_t>(kFilterHalf);
    DrawAddress address = address_;
    address.which = static_cast<std::uint64_t>(sample);
    white[i] = normal_at(address) * (weight ? weight(sample) : 1);
  }
  return convolved(white, taps_);
}

}  // namespace halocline::acoustics
