// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/waveform/linear_phase_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/waveform/kaiser_window.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

constexpr int kHalf = static_cast<int>(kFilterHalf);  // also the number of frequencies
constexpr double kBeta = 6;                           // stop band at -63 dB
constexpr std::size_t kBlock = 1024;                  // samples that fit in the first-level cache

// Each sample is summed in the order of the taps, so that results do not depend on the vector width.
HALOCLINE_VECTOR_CLONES void add_block(const double* padded, const std::vector<double>& taps, double* result,
                                       std::size_t count) {
  for (std::size_t k = 0; k < taps.size(); ++k) {
    const double tap = taps[k];
    for (std::size_t n = 0; n < count; ++n) result[n] += tap * padded[n + k];
  }
}

}  // namespace

// Frequency sampling, with H even:
//   h_k = w_k / (2 kHalf) sum over m of H_m cos(2 pi m k / (2 kHalf)),  m = -kHalf ... kHalf - 1.
std::vector<double> linear_phase_taps(const std::function<double(double)>& amplitude, double rate_hz) {
  require(std::isfinite(rate_hz) && rate_hz > 0, "the sampling rate of a filter must be above 0");
  std::vector<double> response(kHalf + 1);
  for (int m = 0; m <= kHalf; ++m) {
    const double least = 0.5;  // relative to the lowest frequency: a spectrum may be undefined at 0
    const double a = amplitude(std::max<double>(m, least) * rate_hz / (2 * kHalf));
    require(std::isfinite(a) && a >= 0, "the amplitude of a filter must be a number from 0");
    response[static_cast<std::size_t>(m)] = a;
  }
  std::vector<double> cosine(2 * kHalf), taps(2 * kHalf + 1);
  for (int i = 0; i < 2 * kHalf; ++i)
    cosine[static_cast<std::size_t>(i)] = elementary::cos(std::numbers::pi * i / kHalf);
  for (int k = 0; k <= kHalf; ++k) {
    double sum = response[0] + response[kHalf] * (k % 2 == 0 ? 1 : -1);
    for (int m = 1; m < kHalf; ++m)
      sum +=
          2 * response[static_cast<std::size_t>(m)] * cosine[static_cast<std::size_t>(m * k % (2 * kHalf))];
    const double tap = sum / (2 * kHalf) * kaiser_window(k / (kHalf + 1.0), kBeta);
    taps[static_cast<std::size_t>(kHalf + k)] = taps[static_cast<std::size_t>(kHalf - k)] = tap;
  }
  return taps;
}

std::vector<double> convolved(const std::vector<double>& padded, const std::vector<double>& taps) {
  if (padded.size() < taps.size()) return {};
  std::vector<double> result(padded.size() - taps.size() + 1);
  for (std::size_t begin = 0; begin < result.size(); begin += kBlock)
    add_block(&padded[begin], taps, &result[begin], std::min(kBlock, result.size() - begin));
  return result;
}

std::vector<double> filtered(const std::vector<double>& samples, const std::vector<double>& taps) {
  std::vector<double> padded(samples.size() + taps.size() - 1);
  std::copy(samples.begin(), samples.end(), padded.begin() + kHalf);
  return convolved(padded, taps);
}

}  // namespace halocline::acoustics
