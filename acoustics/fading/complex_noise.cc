// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/complex_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Table of normal quantiles at the midpoints of equal intervals of probability, with equally many per
// stratum.
constexpr std::size_t kQuantiles = 1024;
constexpr std::size_t kInStratum = kQuantiles / ComplexNoise::kSines;

const std::array<double, kQuantiles>& normal_quantiles() {
  static const std::array<double, kQuantiles> table = [] {
    std::array<double, kQuantiles> quantiles{};
    for (std::size_t i = 0; i < kQuantiles; ++i) {
      quantiles[i] = normal_quantile((static_cast<double>(i) + 0.5) / kQuantiles);
    }
    return quantiles;
  }();
  return table;
}

}  // namespace

ComplexNoise::ComplexNoise(DrawAddress address) {
  const auto& quantiles = normal_quantiles();
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < kSines; ++k) {
    address.which = k;
    const std::uint64_t bits = bits_at(address);
    frequencies_[k] = quantiles[k * kInStratum + bits % kInStratum];
    phases_[k] = static_cast<double>(bits >> 12) * 0x1p-52;
    sum += frequencies_[k];
  }
  const double mean = sum / kSines;
  // Shifts the frequencies to mean 0 and scales them to rms 1.
  for (double& f : frequencies_) {
    f -= mean;
    squares += f * f;
  }
  const double scale = std::sqrt(kSines / squares);
  for (double& f : frequencies_) f *= scale;
}

// g(t) = 1/sqrt(N) sum_k exp(j 2 pi (f_k B t + phase_k)), with f_k in units of B and phases in cycles.
std::complex<double> ComplexNoise::at(double time_s, double doppler_spread_hz) const {
  std::complex<double> sum = 0;
  for (std::size_t k = 0; k < kSines; ++k) {
    const double cycles = frequencies_[k] * doppler_spread_hz * time_s + phases_[k];
    sum += elementary::polar(1.0, 2 * pi * (cycles - std::floor(cycles)));
  }
  return sum / std::sqrt(static_cast<double>(kSines));
}

}  // namespace halocline::acoustics
