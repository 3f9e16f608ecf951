// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/waveform/analytic_signal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "acoustics/waveform/kaiser_window.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr int kHilbertHalf = 255;       // taps on either side
constexpr double kHilbertBeta = 8;      // stop band at -81 dB
constexpr int kSincHalf = 16;           // taps on either side
constexpr double kSincBeta = 9;         // stop band at -90 dB
constexpr int kMargin = 2 * kSincHalf;  // zeros before and after the samples
constexpr int kPhases = 2048;  // tabulated phases of the sinc between two samples, interpolated linearly

// Taps of the Hilbert transformer at the odd distances 1, 3, ...; those at even distances are 0.
std::vector<double> hilbert_taps() {
  std::vector<double> taps;
  for (int k = 1; k <= kHilbertHalf; k += 2)
    taps.push_back(2 / (pi * k) * kaiser_window(k / (kHilbertHalf + 1.0), kHilbertBeta));
  return taps;
}

// Taps at the distances phase - kSincHalf + 1 ... phase + kSincHalf from the instant.
using SincRow = std::array<double, 2 * kSincHalf>;

double windowed_sinc(double x) {
  const double sinc = x == 0 ? 1 : elementary::sin(pi * x) / (pi * x);
  return sinc * kaiser_window(x / kSincHalf, kSincBeta);
}

// Table of the interpolation filter for each phase.
const std::vector<SincRow>& sinc_rows() {
  static const std::vector<SincRow> rows = [] {
    std::vector<SincRow> table(kPhases + 1);
    for (int p = 0; p <= kPhases; ++p) {
      for (int i = 0; i < 2 * kSincHalf; ++i) {
        table[static_cast<std::size_t>(p)][static_cast<std::size_t>(i)] =
            windowed_sinc(static_cast<double>(p) / kPhases + kSincHalf - 1 - i);
      }
    }
    return table;
  }();
  return rows;
}

// Four numbers in one vector; results are the same for every instruction set.
using Four = double __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double)), may_alias));

// Interpolated value of the real and the imaginary part: the sum of samples times taps, which are
// interpolated between two rows.
HALOCLINE_VECTOR_CLONES std::complex<double> tapped(const SincRow& low, const SincRow& high, double share,
                                                    const double* real, const double* turned) {
  const auto four = [](const double* from) { return reinterpret_cast<const Four*>(from); };
  Four real_sums{}, turned_sums{};
  for (std::size_t i = 0; i < low.size(); i += 4) {
    const Four from = *four(&low[i]), taps = from + share * (*four(&high[i]) - from);
    real_sums += taps * *four(real + i);
    turned_sums += taps * *four(turned + i);
  }
  return {(real_sums[0] + real_sums[1]) + (real_sums[2] + real_sums[3]),
          (turned_sums[0] + turned_sums[1]) + (turned_sums[2] + turned_sums[3])};
}

// Adds to each sample n the Hilbert transform, sum over k of h_k (x[n - k] - x[n + k]), in ascending order of
// k.
HALOCLINE_VECTOR_CLONES void add_turned(const double* x, const std::vector<double>& taps, double* turned,
                                        std::size_t count) {
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const double tap = taps[i];
    const double *before = x - (2 * i + 1), *after = x + (2 * i + 1);
    for (std::size_t n = 0; n < count; ++n) turned[n] += tap * (before[n] - after[n]);
  }
}

}  // namespace

AnalyticSignal::AnalyticSignal(double rate_hz, const std::vector<double>& samples)
    : rate_hz_(rate_hz), count_(std::ssize(samples)) {
  require(std::isfinite(rate_hz) && rate_hz > 0, "the sampling rate of a signal must be above 0");
  for (const double x : samples) require(std::isfinite(x), "the samples of a signal must be finite");
  real_.resize(samples.size() + 2 * kMargin);
  turned_.resize(real_.size());
  std::copy(samples.begin(), samples.end(), real_.begin() + kMargin);
  std::vector<double> padded(samples.size() + 2 * kHilbertHalf);
  std::copy(samples.begin(), samples.end(), padded.begin() + kHilbertHalf);
  static const std::vector<double> taps = hilbert_taps();
  constexpr std::size_t kBlock = 1024;  // samples that fit in the first-level cache
  for (std::size_t begin = 0; begin < samples.size(); begin += kBlock)
    add_turned(&padded[begin + kHilbertHalf], taps, &turned_[begin + kMargin],
               std::min(kBlock, samples.size() - begin));
}

std::complex<double> AnalyticSignal::at(double time_s) const {
  const double place = time_s * rate_hz_;
  if (!(place > -kSincHalf) || !(place < static_cast<double>(count_) + kSincHalf)) return 0;
  const double whole = std::floor(place), phase = (place - whole) * kPhases;
  const auto row = static_cast<std::size_t>(phase);
  const double share = phase - static_cast<double>(row);
  const SincRow &low = sinc_rows()[row], &high = sinc_rows()[std::min<std::size_t>(row + 1, kPhases)];
  const auto first = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(whole) - kSincHalf + 1 + kMargin);
  return tapped(low, high, share, &real_[first], &turned_[first]);
}

}  // namespace halocline::acoustics
