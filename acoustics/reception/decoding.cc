// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/reception/decoding.h"

#include <algorithm>

#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
double chip_energy(const Modem& modem) { return 0.5 * modem.bandwidth_hz / modem.bit_rate_bps; }

BlockDecoder::BlockDecoder(const Modem& modem, bool fades)
    : modem_(modem), interleaved_(fades && is_coded_frequency_shift_keying(modem.error_model)) {}

void BlockDecoder::add(double share, double sinr) {
  sum_ += share * (interleaved_ ? elementary::exp(-chip_energy(modem_) * sinr / kEffectiveRatioBeta)
                                : elementary::log1p(-bit_error_rate(modem_, PowerRatio{sinr})));
}

double BlockDecoder::success(std::int64_t bits) const {
  if (!interleaved_) return elementary::exp(static_cast<double>(bits) * sum_);
  // Cells with a high ratio throughout make exp(-gamma / beta) underflow to 0, hence the bound.
  const double effective = -kEffectiveRatioBeta * elementary::log(std::max(sum_, 1e-300));
  const double error = bit_error_rate(modem_, PowerRatio{effective / chip_energy(modem_)});
  return elementary::exp(static_cast<double>(bits) * elementary::log1p(-error));
}

}  // namespace halocline::acoustics
