// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/orthogonal_symbols.h"

#include <algorithm>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kBitsOfSymbol = 4;
constexpr double kParityGain = 1.1;

}  // namespace

double orthogonal16_symbol_error_rate(PowerRatio energy_over_noise_density) {
  constexpr int kOthers = 15;
  const double g = energy_over_noise_density.value;
  if (!(g > 0)) return static_cast<double>(kOthers) / (kOthers + 1);  // a guess
  double sum = 0, binomial = 1;
  for (int n = 1; n <= kOthers; ++n) {
    binomial *= static_cast<double>(kOthers - n + 1) / n;
    const double term = binomial / (n + 1) * elementary::exp(-g * n / (n + 1));
    sum += n % 2 == 1 ? term : -term;
  }
  return std::clamp(sum, 0.0, static_cast<double>(kOthers) / (kOthers + 1));
}

double orthogonal16_bit_error_rate(PowerRatio eb_over_n0) {
  const double wrong = orthogonal16_symbol_error_rate({kBitsOfSymbol * kParityGain * eb_over_n0.value});
  // 1 - (1 - P_s)^(1/4)
  return std::min(0.5, -elementary::expm1(elementary::log1p(-wrong) / kBitsOfSymbol));
}

}  // namespace halocline::acoustics
