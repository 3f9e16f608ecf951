#include "acoustics/waveform/shaped_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/waveform/kaiser_window.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr int kHalf = 512;   // taps to either side, and frequencies
constexpr double kBeta = 6;  // 63 dB

}  // namespace

// h_k = w_k / (2 kHalf) sum over m of H_m cos(2 pi m k / (2 kHalf)), m = -kHalf ... kHalf - 1, H even.
ShapedNoise::ShapedNoise(const std::function<double(double)>& density, double rate_hz, DrawAddress address)
    : address_(address), taps_(2 * kHalf + 1) {
  require(std::isfinite(rate_hz) && rate_hz > 0, "the sampling rate of noise must be above 0");
  std::vector<double> response(kHalf + 1);
  for (int m = 0; m <= kHalf; ++m) {
    const double least = 0.5;  // of the lowest frequency: a spectrum may have none at 0
    const double n = density(std::max<double>(m, least) * rate_hz / (2 * kHalf));
    require(std::isfinite(n) && n >= 0, "the density of noise must be a number from 0");
    response[static_cast<std::size_t>(m)] = std::sqrt(n * rate_hz / 2);
  }
  std::vector<double> cosine(2 * kHalf);
  for (int i = 0; i < 2 * kHalf; ++i)
    cosine[static_cast<std::size_t>(i)] = elementary::cos(std::numbers::pi * i / kHalf);
  for (int k = 0; k <= kHalf; ++k) {
    double sum = response[0] + response[kHalf] * (k % 2 == 0 ? 1 : -1);
    for (int m = 1; m < kHalf; ++m)
      sum +=
          2 * response[static_cast<std::size_t>(m)] * cosine[static_cast<std::size_t>(m * k % (2 * kHalf))];
    const double tap = sum / (2 * kHalf) * kaiser_window(k / (kHalf + 1.0), kBeta);
    taps_[static_cast<std::size_t>(kHalf + k)] = taps_[static_cast<std::size_t>(kHalf - k)] = tap;
  }
}

std::vector<double> ShapedNoise::samples(std::int64_t first, std::size_t count,
                                         const std::function<double(std::int64_t)>& weight) const {
  std::vector<double> white(count + 2 * kHalf);
  for (std::size_t i = 0; i < white.size(); ++i) {
    const std::int64_t sample = first - kHalf + static_cast<std::int64_t>(i);
    DrawAddress address = address_;
    address.which = static_cast<std::uint64_t>(sample);
    white[i] = normal_at(address) * (weight ? weight(sample) : 1);
  }
  std::vector<double> shaped(count);
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t k = 0; k < taps_.size(); ++k) shaped[n] += taps_[k] * white[n + k];
  }
  return shaped;
}

}  // namespace halocline::acoustics
